// What decides a frame's pixels, besides the scene.
#pragma once

#include <algorithm>
#include <cstdint>

#include "denoise/api/denoiser.h"
#include "gpu/graph/frame_graph.h"
#include "passes/ambient_occlusion/ambient_occlusion.h"
#include "passes/gbuffer/gbuffer.h"
#include "passes/pathtrace/pathtrace.h"
#include "renderer/frame/pipeline.h"

namespace limpid {

/// Means of many samples cover the pixel. Histories follow one point of it: jitter per pixel would flip what
/// a silhouette's pixels see from frame to frame. A network keeps no history, and its guides are means.
inline Jitter defaultJitter(const Pipeline& pipeline) {
    const bool means = pipeline.accumulates() || pipeline.usesNetwork();
    return means ? Jitter::Pixel : Jitter::Off;
}

/// As after --jitter.
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

    /// Those of the path tracer, as the integrator uses them: `direct` has one bounce at most.
    PathtraceSettings pathsTraced() const {
        PathtraceSettings traced = pathtrace;
        if (pipeline.integrator == Integrator::Direct) traced.maxDepth = std::min(traced.maxDepth, 1);
        return traced;
    }
    bool operator==(const RenderSettings&) const = default;
};

}  // namespace limpid
