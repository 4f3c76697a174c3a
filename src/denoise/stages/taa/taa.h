// Temporal anti-aliasing, the last step of every denoiser: a mean over frames whose rays go through different
// points of their pixels (Jitter::Frame). B. Karis, "High-Quality Temporal Supersampling", SIGGRAPH 2014; the
// past is clipped as in M. Salvi, "An Excursion in Temporal Supersampling", GDC 2016. The formulas are in
// docs/denoising.md.
#pragma once

#include "base/params.h"
#include "denoise/api/denoiser_input.h"
#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

/// What a user may set; taaParams() is where range and meaning stand.
struct TaaSettings {
    float frames = 1.0f;
    bool operator==(const TaaSettings&) const = default;
};
const ParamTable<TaaSettings>& taaParams();

/// `beauty` (rgba32f, not negative) with smooth edges; as it is if settings.frames is 1. Pass and history
/// "taa".
gpu::ImageHandle antialias(gpu::FrameGraph& graph, const DenoiserInput& input, gpu::ImageHandle beauty,
                           const TaaSettings& settings);

}  // namespace limpid::denoise
