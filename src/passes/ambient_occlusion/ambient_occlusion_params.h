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
    uint stream;  // stream of random numbers
    uint seed;
    uint firstPoint;  // number of the dispatch's first ray in sequences of points
    uint firstRay;    // first ray of this dispatch; earlier ones are in `before`
    uint rays;        // per pixel in this dispatch
    float reach;      // length of a ray, world units
    float divisor;    // divides the sum of unoccluded rays: number of rays in the last dispatch, else 1
};

struct AmbientOcclusionSignalParams {
    uint width;
    uint height;
};

#ifdef __cplusplus
}  // namespace limpid
#endif
#endif
