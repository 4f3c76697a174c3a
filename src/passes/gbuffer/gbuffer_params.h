// Parameters of the G-buffer shader. Included by C++ and GLSL.
#ifndef LIMPID_PASSES_GBUFFER_PARAMS_H
#define LIMPID_PASSES_GBUFFER_PARAMS_H

#include "shaders/camera.h"
#include "shaders/scene_layout.h"

#ifdef __cplusplus
namespace limpid {
using layout::SceneParams;
#endif

struct GBufferParams {
    SceneParams scene;
    ViewParams view;
};

#ifdef __cplusplus
}  // namespace limpid
#endif
#endif
