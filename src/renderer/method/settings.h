// Everything besides the scene that determines a frame's pixels.
#pragma once

#include <algorithm>
#include <cstdint>

#include "denoise/api/denoiser.h"
#include "gpu/graph/frame_graph.h"
#include "passes/ambient_occlusion/ambient_occlusion.h"
#include "passes/gbuffer/gbuffer.h"
#include "passes/pathtrace/pathtrace.h"
#include "renderer/method/pipeline.h"

namespace limpid {

/// Means of many samples need jitter to cover the pixel, and so do a network's guides. Histories follow one
/// point: with jitter per pixel, pixels at silhouettes would see another surface in each frame. With one
/// point for all pixels, their last step averages frames to smooth edges (TaaSettings). A filter of single
/// frames does not, and frames that are jittered would only shake. `samples`: per pixel and frame. Where a
/// history is made for several, their mean smooths edges, as in frames of renderers of films.
inline Jitter defaultJitter(const Pipeline& pipeline, uint64_t samples = 1) {
    if (pipeline.accumulates() || pipeline.usesNetwork()) return Jitter::Pixel;
    if (pipeline.denoiser->samples > 1 && samples > 1) return Jitter::Pixel;
    return pipeline.denoiser->keepsHistory ? Jitter::Frame : Jitter::Off;
}

/// The value for --jitter.
inline const char* toString(Jitter jitter) {
    return jitter == Jitter::Pixel ? "pixel" : jitter == Jitter::Frame ? "frame" : "off";
}

struct RenderSettings {
    gpu::Extent extent{1280, 720};
    uint32_t seed = 0;
    uint32_t samplesPerLaunch = 1;  ///< 1 or more
    Jitter jitter = Jitter::Pixel;
    Pipeline pipeline;
    bool layers = false;  ///< false: beauty alone, which is faster
    PathtraceSettings pathtrace;
    GBufferSettings gbuffer;
    AmbientOcclusionSettings ambientOcclusion;
    denoise::DenoiserSettings denoisers;
    denoise::DenoiserNetworks networks;

    /// The path tracer's settings as the integrator uses them: `direct` has at most one bounce.
    PathtraceSettings pathsTraced() const {
        PathtraceSettings traced = pathtrace;
        if (pipeline.integrator == Integrator::Direct) traced.maxDepth = std::min(traced.maxDepth, 1);
        return traced;
    }
    bool operator==(const RenderSettings&) const = default;
};

}  // namespace limpid
