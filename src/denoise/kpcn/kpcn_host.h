// The network's layers and kernels on the host, with oneDNN: used for software devices, where it is several
// times as fast as shaders.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "denoise/kpcn/kpcn_weights.h"

namespace limpid::denoise {

/// Whether Limpid was built with oneDNN.
bool kpcnHostAvailable();

/// A part of a picture: `columns` x `rows` pixels. Only `width` x `height` of them, from (left, top) on, are
/// computed; the rest is the border.
struct KpcnHostTile {
    uint32_t columns, rows, left, top, width, height;
};

/// Not thread-safe: one run at a time.
class KpcnHost {
  public:
    /// Throws Error without oneDNN.
    explicit KpcnHost(const KpcnWeights& weights);
    ~KpcnHost();

    /// `channels`: the network's input, in slabs of 16. `light`: the light to average, four floats per pixel.
    /// `faces`: the normal and a flag for no normal, four signed bytes per pixel (kpcn_features.comp). These
    /// three cover the whole part. `clean`: the output, four floats per pixel, only the computed pixels; its
    /// rows are `pitch` pixels apart.
    void run(size_t side, const KpcnHostTile& tile, std::span<const float> channels,
             std::span<const float> light, std::span<const uint32_t> faces, std::span<float> clean,
             size_t pitch);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace limpid::denoise
