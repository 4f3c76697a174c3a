// The last step of methods that do not separate the albedo: scattered light plus emission.
#pragma once

#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

/// Beauty, rgba32f, alpha 1. `scattered` and `emission` are rgba32f; `disocclusion` is
/// TemporalImages::disocclusion; with `showDisocclusion` its causes are shown as colours instead of light.
gpu::ImageHandle compose(gpu::FrameGraph& graph, gpu::ImageHandle scattered, gpu::ImageHandle emission,
                         gpu::ImageHandle disocclusion, bool showDisocclusion);

}  // namespace limpid::denoise
