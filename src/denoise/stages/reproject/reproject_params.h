// When a pixel of the previous frame shows the same surface point. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_REPROJECT_PARAMS_H
#define LIMPID_DENOISE_REPROJECT_PARAMS_H

#include "denoise/stages/motion_encoding.h"
#include "denoise/stages/normal_encoding.h"
#include "shaders/common/camera.h"

#ifdef __cplusplus
namespace limpid::denoise {
#endif

struct ReprojectTests {
    float normal;   // minimum cosine between the previous normal and the expected one
    float depth;    // maximum deviation from the expected distance
    uint relative;  // 1: `depth` is a share of the distance, with more room on tilted planes; 0: world units
    uint search;    // 1: search 3x3 pixels if all four bilinear taps are rejected
    NormalEncoding previousNormals;
    MotionEncoding motion;
};

#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif
