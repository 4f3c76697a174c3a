// Parameters of the path-tracing shader. Included by C++ and GLSL.
#ifndef LIMPID_PASSES_PATHTRACE_PARAMS_H
#define LIMPID_PASSES_PATHTRACE_PARAMS_H

#include "shaders/common/camera.h"
#include "shaders/common/scene_layout.h"
#include "shaders/common/sobol_table.h"

#ifdef __cplusplus
namespace limpid {
using layout::SceneParams;
#endif

struct PathtraceParams {
    SobolTable points;
    SceneParams scene;
    ViewParams view;
    uint samples;  // per pixel in this launch
    uint maxDepth;
    uint maxTransmissionDepth;
    uint rouletteDepth;
    float fireflyClamp;  // 0: off
    uint throughMirrors;
    uint throughGlass;
};

#ifdef __cplusplus
}  // namespace limpid
#endif
#endif
