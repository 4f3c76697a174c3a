// Parameters of the ambient-occlusion shader. Included by C++ and GLSL.
#ifndef LIMPID_PASSES_AMBIENT_OCCLUSION_PARAMS_H
#define LIMPID_PASSES_AMBIENT_OCCLUSION_PARAMS_H

#include "shaders/common/scene_layout.h"
#include "shaders/common/sobol_table.h"

#ifdef __cplusplus
namespace limpid {
using layout::SceneParams;
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
#endif

/// Keeps the random numbers separate from those of passes that trace primary rays.
LIMPID_CONST uint OCCLUSION_STREAMS = 0x0cc1u;

struct AmbientOcclusionParams {
    SobolTable points;
    SceneParams scene;
    uint width;
    uint height;
    uint stream;  // stream of random numbers
    uint seed;
    uint firstRay;  // first ray of this dispatch; earlier ones are in `before`
    uint rays;      // per pixel in this dispatch
    float reach;    // length of a ray, world units
    float divisor;  // divides the sum of unoccluded rays: number of rays in the last dispatch, else 1
};

struct AmbientOcclusionSignalParams {
    uint width;
    uint height;
};

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid
#endif
#endif
