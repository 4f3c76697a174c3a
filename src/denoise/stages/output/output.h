// The last pass of an embedded denoiser: it writes the result to the caller's image.
#pragma once

#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

/// Pass "output/NAME". `result` is RGBA16Float (rounded to nearest, clamped to the range of half floats) or
/// RGBA32Float.
void output(gpu::FrameGraph& graph, const char* name, gpu::ImageHandle picture, gpu::ImageHandle result);

}  // namespace limpid::denoise
