// The filter of a network behind SVGF on the CPU. docs/nano.md has the formulas.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "denoise/methods/nano/nano_tiles.h"
#include "denoise/nano_host/host_layers.h"

namespace limpid::denoise {

/// A pixel's light of both signals: diffuse red, green, blue, and 1 if a surface is seen; the same of
/// specular light. Else all are 0.
using HostLight = std::array<float, 8>;

class HostFilter {
  public:
    HostFilter(const NanoNetwork& network, gpu::Extent extent);

    /// `layers` have run; `light` and `result` as NanoHost::run() has them.
    void run(const HostLayers& layers, const NanoTile& tile, std::span<const uint16_t> light,
             std::span<float> result);

  private:
    struct Level {
        gpu::Extent extent;
        uint32_t channels = 0, logits = 0;  ///< of a pixel; logits of both signals
        std::vector<HostLight> light, result;
        /// For each signal, the bias and the weights of the logit of the coarser level.
        std::vector<float> pool;
        uint32_t bandRows = 0;  ///< whose logits are made at a time
        std::vector<float> band;
        std::optional<neural::ChannelsLastConvolution> logitsOfBand;
    };

    void pool(size_t level, std::span<const float> channels);
    /// The logits of rows `top` to `top` + bandRows - 1, or of the last bandRows. Returns the first one's
    /// number.
    uint32_t makeBand(Level& level, std::span<const float> channels, uint32_t top);
    void filter(size_t level, std::span<const float> channels);
    void filterFinest(std::span<const float> channels, const NanoTile& tile, std::span<float> result);

    std::array<Level, NANO_LEVELS> levels_;
};

}  // namespace limpid::denoise
