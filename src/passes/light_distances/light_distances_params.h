// Parameters of the shaders that map distances around lights. Included by C++ and GLSL.
#ifndef LIMPID_PASSES_LIGHT_DISTANCES_PARAMS_H
#define LIMPID_PASSES_LIGHT_DISTANCES_PARAMS_H

#include "shaders/common/scene_layout.h"

#ifdef __cplusplus
namespace limpid {
using layout::SceneParams;
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
#endif

LIMPID_CONST uint LIGHT_MAP_RAYS = 3u;  // rows and columns of rays through a texel
/// Surfaces between the rays may be farther away than what these meet: by as much as a texel's rays differ,
/// within these shares of the distance; and by this share beyond what all rays through a texel and its
/// neighbours meet.
LIMPID_CONST float LIGHT_MAP_LEAST_MARGIN = 0.02;
LIMPID_CONST float LIGHT_MAP_GREATEST_MARGIN = 0.1;
LIMPID_CONST float LIGHT_MAP_MARGIN_AROUND = 0.02;

struct LightDistancesParams {
    SceneParams scene;
    uint maps;
};

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid
#endif
#endif
