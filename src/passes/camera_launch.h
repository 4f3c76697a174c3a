// What passes that trace primary rays have in common: the camera, the points in the pixels, the random
// numbers.
#pragma once

#include "gpu/frame_graph.h"
#include "shaders/camera.h"

namespace limpid {

/// One launch of primary rays.
struct CameraLaunch {
    gpu::Extent extent;
    CameraParams camera;
    CameraParams previousCamera;  ///< of the previous frame of a sequence, for motion
    bool hasPrevious = false;     ///< false: no previous frame, all motion is invalid
    uint32_t frame = 0;           ///< launches since the last reset
    uint32_t stream = 0;          ///< of random numbers; in a still the same as `frame`
    uint32_t seed = 0;
    bool jitterPerPixel = true;
    vec2 jitter{0.5f};  ///< the point inside every pixel, otherwise
};

inline ViewParams viewParams(const CameraLaunch& launch) {
    ViewParams view{};
    view.camera = launch.camera;
    view.previousCamera = launch.previousCamera;
    view.hasPrevious = launch.hasPrevious ? 1u : 0u;
    view.width = launch.extent.width;
    view.height = launch.extent.height;
    view.frame = launch.frame;
    view.stream = launch.stream;
    view.seed = launch.seed;
    view.jitterPerPixel = launch.jitterPerPixel ? 1u : 0u;
    view.jitter = launch.jitter;
    return view;
}

}  // namespace limpid
