// The last pass of an embedded denoiser: its picture goes into an image of the caller's.
#pragma once

#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

/// Pass "output/NAME". `result` is RGBA16Float (rounded to nearest, clamped to what halves hold) or
/// RGBA32Float.
void output(gpu::FrameGraph& graph, const char* name, gpu::ImageHandle picture, gpu::ImageHandle result);

}  // namespace limpid::denoise
