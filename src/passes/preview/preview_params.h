// Parameters of the preview shader. Included by C++ and GLSL.
#ifndef LIMPID_PASSES_PREVIEW_PARAMS_H
#define LIMPID_PASSES_PREVIEW_PARAMS_H

#include "shaders/common/camera.h"

#ifdef __cplusplus
namespace limpid {
#endif

struct PreviewParams {
    CameraParams camera;
    uint width;
    uint height;
};

#ifdef __cplusplus
}  // namespace limpid
#endif
#endif
