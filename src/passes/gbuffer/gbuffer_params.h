// Parameters of the G-buffer shader. Included by C++ and GLSL.
#ifndef LIMPID_PASSES_GBUFFER_PARAMS_H
#define LIMPID_PASSES_GBUFFER_PARAMS_H

#include "shaders/common/camera.h"
#include "shaders/common/scene_layout.h"
#include "shaders/common/sobol_table.h"

#ifdef __cplusplus
namespace limpid {
using layout::SceneParams;
#endif

struct GBufferParams {
    SobolTable points;
    SceneParams scene;
    ViewParams view;
};

#ifdef __cplusplus
}  // namespace limpid
#endif
#endif
