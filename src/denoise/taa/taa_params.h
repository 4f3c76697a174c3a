// Parameters of temporal anti-aliasing. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_TAA_PARAMS_H
#define LIMPID_DENOISE_TAA_PARAMS_H

#ifdef __cplusplus
#include "base/math.h"
namespace limpid::denoise {
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
#endif

LIMPID_CONST float TAA_DEVIATIONS =
    1.25;  // of the 3x3 pixels around: what the past may differ from their mean by

struct TaaParams {
    uint width;
    uint height;
    float frames;
};

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif
