// Parameters of the tone-mapping pass. Included by C++ and GLSL.
#ifndef LIMPID_PASSES_TONEMAP_PARAMS_H
#define LIMPID_PASSES_TONEMAP_PARAMS_H

#include "shaders/common/camera.h"

#ifdef __cplusplus
namespace limpid {
#endif

struct TonemapParams {
    uint width;
    uint height;
    float scale;  // factor for radiance, before the curve
    uint curve;   // image::ToneCurve
};

#ifdef __cplusplus
}  // namespace limpid
#endif
#endif
