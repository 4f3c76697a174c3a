// The surfaces stage: packs normal, distance and instance of each pixel's surface for methods that read them
// many times and compare them with those of the previous frame.
#pragma once

#include "denoise/api/denoiser_input.h"

namespace limpid::denoise {

/// Histories of the graph; `previous` holds the previous frame's surfaces.
struct Surfaces {
    gpu::History surfaces;   ///< two words: octahedral normal, distance from the eye (0: nothing seen)
    gpu::History instances;  ///< r32ui: instance number + 1 (0: nothing seen)
};

/// Pass "surfaces".
Surfaces recordSurfaces(gpu::FrameGraph& graph, const DenoiserInput& input);

}  // namespace limpid::denoise
