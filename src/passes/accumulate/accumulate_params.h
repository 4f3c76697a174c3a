// Parameters of the accumulation shader. Included by C++ and GLSL.
#ifndef LIMPID_PASSES_ACCUMULATE_PARAMS_H
#define LIMPID_PASSES_ACCUMULATE_PARAMS_H

#ifdef __cplusplus
#include "base/math.h"
namespace limpid {
#endif

struct AccumulateParams {
    uint width;
    uint height;
    float countBefore;  // samples in the mean so far
    float countAdded;   // samples in this launch
    vec3 weights;       // the alpha channel is the variance of dot(value, weights)
    uint perComponent;  // 1: alpha is the mean variance of the components instead
};

#ifdef __cplusplus
}  // namespace limpid
#endif
#endif
