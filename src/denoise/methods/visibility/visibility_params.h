// Parameters of the passes that denoise visibility. The levels take those of SVGF's. Included by C++ and
// GLSL.
#ifndef LIMPID_DENOISE_VISIBILITY_PARAMS_H
#define LIMPID_DENOISE_VISIBILITY_PARAMS_H

#include "denoise/stages/reproject/reproject_params.h"
#include "shaders/common/camera.h"

#ifdef __cplusplus
namespace limpid::denoise {
#endif

/// The minimum weights of a new frame in the means.
struct VisibilityAlphas {
    float slow;
    float fast;
};

struct VisibilityAccumulateParams {
    CameraParams camera;
    uint width;
    uint height;
    ReprojectTests tests;
    VisibilityAlphas alphas;
    float longest;  // frames
};

struct VisibilityAntilagParams {
    uint width;
    uint height;
    VisibilityAlphas alphas;
};

#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif
