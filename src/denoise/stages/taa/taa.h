// Temporal anti-aliasing, the last step of every denoiser: averages frames that are jittered within the
// pixel (Jitter::Frame), after edges.h has smoothed the edges of each. B. Karis, "High-Quality Temporal
// Supersampling", SIGGRAPH 2014; the history is clipped as in M. Salvi, "An Excursion in Temporal
// Supersampling", GDC 2016. The formulas are in docs/denoising.md.
#pragma once

#include "base/params.h"
#include "denoise/api/denoiser_input.h"
#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

/// User settings; taaParams() gives ranges and descriptions.
struct TaaSettings {
    float frames = 0.0f;  ///< 0: as in framesToAverage()
    float stillFrames = 8.0f;
    int edges = 8;  ///< see smoothEdges(); 0: off. Only in frames with DenoiserInput::jitterChanges
    bool operator==(const TaaSettings&) const = default;
};
const ParamTable<TaaSettings>& taaParams();

/// Returns settings.frames, or for 0 the default: 2 if DenoiserInput::jitterChanges is set, otherwise 1,
/// which is off.
float framesToAverage(const TaaSettings& settings, bool jitterChanges);

/// Where a method may write the picture for antialias(): on GPUs (filters in buffers) an RGBA16Float image,
/// which they read faster than floats; on CPUs empty. If anti-aliasing is off, input.target.
gpu::ImageHandle targetBeforeTaa(gpu::FrameGraph& graph, const DenoiserInput& input,
                                 const TaaSettings& settings);

/// Anti-aliases `beauty` (not negative), to rgba32f; returns it unchanged if that is off. The last pass and
/// its history are called "taa".
gpu::ImageHandle antialias(gpu::FrameGraph& graph, const DenoiserInput& input, gpu::ImageHandle beauty,
                           const TaaSettings& settings);

}  // namespace limpid::denoise
