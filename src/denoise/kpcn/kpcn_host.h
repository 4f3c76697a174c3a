// The network's layers and kernels on the CPU, for devices that are CPUs themselves: oneDNN is several times
// as fast there as shaders.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "denoise/kpcn/kpcn_weights.h"

namespace limpid::denoise {

/// Whether Limpid was built with oneDNN.
bool kpcnHostAvailable();

/// A part of a picture: `columns` x `rows` pixels, of which those from (left, top) on, `width` x `height`,
/// are wanted.
struct KpcnHostTile {
    uint32_t columns, rows, left, top, width, height;
};

/// One run at a time.
class KpcnHost {
  public:
    /// Throws Error without oneDNN.
    explicit KpcnHost(const KpcnWeights& weights);
    ~KpcnHost();

    /// `channels`: what the network sees, in slabs of 16; `light`: what is averaged, four floats a pixel;
    /// `faces`: the normal and whether there is none, four signed bytes a pixel (kpcn_features.glsl); all of
    /// the whole part. `clean`: four floats a pixel, of the wanted ones; its rows begin every `pitch` pixels.
    void run(size_t side, const KpcnHostTile& tile, std::span<const float> channels,
             std::span<const float> light, std::span<const uint32_t> faces, std::span<float> clean,
             size_t pitch);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace limpid::denoise
