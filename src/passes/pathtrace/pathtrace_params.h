// Parameters of the path-tracing shader. Included by C++ and GLSL.
#ifndef LIMPID_PASSES_PATHTRACE_PARAMS_H
#define LIMPID_PASSES_PATHTRACE_PARAMS_H

#include "shaders/camera.h"
#include "shaders/scene_layout.h"

#ifdef __cplusplus
namespace limpid {
using layout::SceneParams;
#endif

struct PathtraceParams {
    SceneParams scene;
    CameraParams camera;
    CameraParams previousCamera;
    uint width;
    uint height;
    uint frame;   // since the last reset
    uint stream;  // of random numbers
    uint seed;
    uint samples;  // per pixel in this launch
    uint maxDepth;
    uint rouletteDepth;
    float fireflyClamp;  // 0: off
    uint jitterPerPixel;
    vec2 jitter;       // otherwise: the point in every pixel
    uint hasPrevious;  // 0: there is no previous frame, all motion is invalid
};

#ifdef __cplusplus
}  // namespace limpid
#endif
#endif
