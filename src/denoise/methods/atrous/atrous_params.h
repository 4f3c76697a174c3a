// Parameters of the a-trous filter's passes. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_ATROUS_PARAMS_H
#define LIMPID_DENOISE_ATROUS_PARAMS_H

#include "shaders/common/camera.h"

#ifdef __cplusplus
namespace limpid::denoise {
#endif

struct AtrousDemodulateParams {
    CameraParams camera;
    uint width;
    uint height;
    uint plane;            // depth is measured along `forward`, not along the ray
    float minAlbedo;       // 0: light is filtered with its albedo
    float givenMinAlbedo;  // above 0: the given light is already divided by the albedo
};

struct AtrousLevelParams {
    CameraParams camera;
    uint width;
    uint height;
    int step;           // pixels
    float normalScale;  // 2 log2(e) / (step^2 normal_factor)
    float depthScale;   // sqrt(log2(e) / depth_factor)
    vec2 toScreen;      // 2 / width, -2 / height; saves a division per tap
    float fade;         // 4^(level - 1) / sample_target
    float colorScale;   // 4^(level - 1) log2(e) / color_factor
};

#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif
