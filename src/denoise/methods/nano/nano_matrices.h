// The convolutions of `nano` on cooperative matrices, where a device has them: about five times as fast.
#pragma once

#include <cstddef>
#include <string>

#include "denoise/methods/nano/nano_params.h"
#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

struct NanoConvolution {
    std::string pass;
    size_t level = 0;
    uint32_t taps = NANO_AROUND;
    NanoConvolveParams params{};
    gpu::ImageHandle inputs, coarser, weights, outputs;  ///< `coarser`: any, if there is none
};

/// Records what nano_convolve.comp computes.
void convolveByMatrices(gpu::FrameGraph& graph, const NanoConvolution& convolution);

}  // namespace limpid::denoise
