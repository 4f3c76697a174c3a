// Parameters of the ambient-occlusion shader. Included by C++ and GLSL.
#ifndef LIMPID_PASSES_AMBIENT_OCCLUSION_PARAMS_H
#define LIMPID_PASSES_AMBIENT_OCCLUSION_PARAMS_H

#include "shaders/common/scene_layout.h"

#ifdef __cplusplus
namespace limpid {
using layout::SceneParams;
#endif

struct AmbientOcclusionParams {
    SceneParams scene;
    uint width;
    uint height;
    uint stream;  // of random numbers
    uint seed;
    uint firstRay;  // of this dispatch; those before are in `before`
    uint rays;      // of this dispatch, per pixel
    float reach;    // of a ray, world units
    float divisor;  // of the sum of open rays: their number in the last dispatch, 1 in others
};

struct AmbientOcclusionSignalParams {
    uint width;
    uint height;
};

#ifdef __cplusplus
}  // namespace limpid
#endif
#endif
