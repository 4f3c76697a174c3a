// Parameters of temporal anti-aliasing. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_TAA_PARAMS_H
#define LIMPID_DENOISE_TAA_PARAMS_H

#ifdef __cplusplus
#include "base/math.h"
namespace limpid::denoise {
#endif

struct TaaParams {
    uint width;
    uint height;
    float frames;
    float stillFrames;  // `frames` or more
    vec2 jitter;        // from the pixels' centres, pixels
};

#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif
