// The surfaces stage: packs normal, distance and instance of each pixel's surface for methods that read them
// many times and compare them with those of the previous frame.
#pragma once

#include "denoise/api/denoiser_input.h"

namespace limpid::denoise {

/// Surfaces that a pass has yet to write.
Surfaces makeSurfaces(gpu::FrameGraph& graph, gpu::Extent extent, gpu::Backing filters);

/// Pass "surfaces", unless the input has surfaces.
Surfaces recordSurfaces(gpu::FrameGraph& graph, const DenoiserInput& input);

}  // namespace limpid::denoise
