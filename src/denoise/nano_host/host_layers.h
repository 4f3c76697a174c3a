// The convolutions of a network behind SVGF on the CPU, in single precision.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "denoise/methods/nano/nano_network.h"
#include "gpu/graph/frame_graph.h"
#include "neural/channels_last.h"

namespace limpid::denoise {

/// A layer's weights as neural::ChannelsLastConvolution wants them. Its inputs from the coarser level apart.
struct HostLayer {
    std::vector<float> weights, coarser, biases;
};

/// `taps`: of a side.
HostLayer readHostLayer(const NanoNetwork& network, const NanoLayer& layer, uint32_t taps);

class HostLayers {
  public:
    /// `extent`: multiples of 2^(NANO_LEVELS - 1).
    HostLayers(const NanoNetwork& network, gpu::Extent extent);

    /// Computes all layers but the logits. `channels`: the first layer's, halves.
    void run(std::span<const uint16_t> channels);

    /// What the logits of a level are made from; a pixel's channels side by side.
    std::span<const float> channels(size_t level) const { return levels_[level].kept; }

  private:
    struct Level {
        gpu::Extent extent;
        std::vector<float> kept, spare, coarser;  ///< coarser: what the coarser level adds, in its size
        std::optional<neural::ChannelsLastConvolution> halve, fromCoarser, join, after;
        std::vector<neural::ChannelsLastConvolution> around;
    };

    void makeDown(const NanoNetwork& network, size_t level);
    void makeUp(const NanoNetwork& network, size_t level);
    void up(size_t level);

    std::array<Level, NANO_LEVELS> levels_;
};

}  // namespace limpid::denoise
