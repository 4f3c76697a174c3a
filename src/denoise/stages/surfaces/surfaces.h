// The surfaces stage: packs normal, distance and instance of each pixel's surface for methods that read them
// many times and compare them with those of the previous frame.
#pragma once

#include "denoise/api/denoiser_input.h"

namespace limpid::denoise {

/// The history of surfaces, which a pass has yet to write: two words, surface_texel.glsl.
gpu::History makeSurfaces(gpu::FrameGraph& graph, gpu::Extent extent, gpu::Backing filters);

/// What a pass binds in place of ids if there are none, and does not read.
gpu::ImageHandle noIds(gpu::FrameGraph& graph);

/// Pass "surfaces", unless the input has surfaces.
gpu::History recordSurfaces(gpu::FrameGraph& graph, const DenoiserInput& input);

}  // namespace limpid::denoise
