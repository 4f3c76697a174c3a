// What decides a frame's pixels, besides the scene.
#pragma once

#include <cstdint>

#include "denoise/denoiser.h"
#include "gpu/frame_graph.h"
#include "passes/ambient_occlusion/ambient_occlusion.h"
#include "passes/gbuffer/gbuffer.h"
#include "passes/pathtrace/pathtrace.h"
#include "renderer/pipeline.h"

namespace limpid {

/// Where in its pixel a primary ray goes.
enum class Jitter {
    Pixel,  ///< anywhere, each pixel by its own random numbers; the first sample of frame 0 through the
            ///< centre
    Frame,  ///< one point for all pixels of a frame: Halton sequence in bases 2 and 3
    Off,    ///< the centre
};

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
    bool operator==(const RenderSettings&) const = default;
};

}  // namespace limpid
