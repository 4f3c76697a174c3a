// Parameters of the joint bilateral filter's pass. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_BILATERAL_PARAMS_H
#define LIMPID_DENOISE_BILATERAL_PARAMS_H

#include "shaders/common/camera.h"

#ifdef __cplusplus
namespace limpid::denoise {
#endif

struct BilateralParams {
    CameraParams camera;
    uint width;
    uint height;
    int radius;         // pixels
    float spatial;      // 1 / (2 sigma^2), per squared pixel
    float normalPower;  // exponent of the cosine between normals
    float minAlbedo;    // albedos below this count as this
    float plane;        // tolerated distance from the pixel's plane, relative to the distance from the eye
};

#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif
