// The last step of methods that keep no albedo apart: scattered light plus emission.
#pragma once

#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

/// Beauty, rgba32f, alpha 1. `scattered` and `emission` are rgba32f; `cases` is HistoryImages::cases, shown
/// as colours if `showCases`.
gpu::ImageHandle compose(gpu::FrameGraph& graph, gpu::ImageHandle scattered, gpu::ImageHandle emission,
                         gpu::ImageHandle cases, bool showCases);

}  // namespace limpid::denoise
