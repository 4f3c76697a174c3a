// Shared by all passes that trace primary rays: the camera, the jitter and the random numbers.
#pragma once

#include "gpu/graph/frame_graph.h"
#include "shaders/common/camera.h"
#include "shaders/common/sampler.h"

namespace limpid {

/// Where a primary ray goes through its pixel. The first sample since the last reset goes through the centre.
enum class Jitter : uint32_t {
    Pixel = JITTER_PIXEL,  ///< a random point for each pixel
    Frame = JITTER_FRAME,  ///< the same point for all pixels, a new one for each sample: Halton sequence in
                           ///< bases 2 and 3
    Off = JITTER_OFF,      ///< the centre
};

/// The random numbers, --sampler (shaders/common/rng.glsl).
enum class Sampler : uint32_t {
    Pcg = SAMPLER_PCG,
    Tea = SAMPLER_TEA,
    Sobol = SAMPLER_SOBOL,
};

/// Where ray `index` goes with Jitter::Frame: offset from the pixel's centre, pixels, y down. `span`: see
/// CameraLaunch. The same as subpixel() in shaders/common/camera_ray.glsl.
vec2 framePoint(uint32_t index, float span);

/// The span for frames with this many rays a pixel. Means of many cover the pixel. Frames with one ray each
/// differ less if it stays near the centre; the camera's own movement and interpolation cover the rest
/// (docs/denoising.md, "Temporal anti-aliasing").
constexpr float jitterSpanOf(uint64_t raysOfAFrame) {
    return raysOfAFrame == 1 ? 0.5f : 1.0f;
}

/// One launch of primary rays.
struct CameraLaunch {
    gpu::Extent extent;
    CameraParams camera;
    CameraParams previousCamera;  ///< camera of the previous frame of a sequence, for motion
    bool hasPrevious = false;     ///< false: no previous frame, all motion is invalid
    uint32_t firstSample = 0;     ///< samples per pixel since the last reset, before this launch
    /// Number of the first sample in sequences of points: over all launches and frames, without gaps.
    uint32_t firstPoint = 0;
    uint32_t stream = 0;  ///< stream of random numbers; in a still, the launch's number
    uint32_t seed = 0;
    Jitter jitter = Jitter::Pixel;
    float jitterSpan = 1.0f;     ///< part of the pixel that Jitter::Frame covers, around the centre
    uint64_t samplesBefore = 0;  ///< per pixel in the mean, before this launch
    Sampler sampler = Sampler::Pcg;
};

inline ViewParams viewParams(const CameraLaunch& launch) {
    ViewParams view{};
    view.camera = launch.camera;
    view.previousCamera = launch.previousCamera;
    view.hasPrevious = launch.hasPrevious ? 1u : 0u;
    view.width = launch.extent.width;
    view.height = launch.extent.height;
    view.firstSample = launch.firstSample;
    view.stream = launch.stream;
    view.seed = launch.seed;
    view.jitter = static_cast<uint32_t>(launch.jitter);
    view.jitterSpan = launch.jitterSpan;
    view.samplesBefore = static_cast<float>(launch.samplesBefore);
    return view;
}

}  // namespace limpid
