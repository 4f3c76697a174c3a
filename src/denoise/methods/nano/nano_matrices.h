// The convolutions of `nano` and `film` on cooperative matrices, where a device has them: about five times as
// fast.
#pragma once

#include <string>

#include "denoise/methods/nano/nano_network.h"
#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

struct NanoConvolution {
    std::string pass;
    NanoShare share{};
    uint32_t taps = NANO_AROUND;
    NanoConvolveParams params{};
    gpu::ImageHandle inputs, coarser, weights, outputs;  ///< `coarser`: any, if there is none
};

/// Records what nano_convolve.comp computes.
void convolveByMatrices(gpu::FrameGraph& graph, const NanoConvolution& convolution);

}  // namespace limpid::denoise
