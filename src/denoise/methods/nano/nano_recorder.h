// A network behind SVGF, and the filter whose weights it predicts. docs/nano.md has the formulas.
#pragma once

#include "denoise/methods/method.h"
#include "denoise/methods/nano/nano_network.h"
#include "denoise/methods/svgf/svgf.h"

namespace limpid::denoise {

/// Records what the network makes of a frame's stages, and returns the light of both signals. `strength`:
/// from 0 to 1, the share of the network's result where it would replace SVGF's.
SvgfLight recordNetwork(gpu::FrameGraph& graph, const DenoiserInput& input, const SvgfStages& stages,
                        const NanoNetwork& network, float strength);

}  // namespace limpid::denoise
