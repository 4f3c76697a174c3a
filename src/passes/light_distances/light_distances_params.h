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

LIMPID_CONST uint LIGHT_MAP_RAYS = 2u;  // rows and columns of rays through a texel
/// Surfaces between rays may be a little farther away than those that the rays meet.
LIMPID_CONST float LIGHT_MAP_MARGIN = 1.1;

struct LightDistancesParams {
    SceneParams scene;
    uint maps;
};

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid
#endif
#endif
