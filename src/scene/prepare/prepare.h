// The last step before rendering a scene that was loaded or built in.
#pragma once

#include "scene/model/scene.h"

namespace limpid::scene {

/// When a scene without an environment gets a soft sky.
enum class SkyRule {
    Never,          ///< the user asked for black
    WithoutLights,  ///< if there is no punctual light, and no emissive material in use
    InTheDark,      ///< also if its lights leave most of the first camera's view black (light_reach.h)
};
/// `InTheDark`: the minimum share of dark pixels among those that show a surface.
inline constexpr double darkShareForSky = 0.75;

/// Checks the invariants of scene.h and throws Error with the first violation (validate.h). Makes
/// materials opaque that only say that they may be transparent (opaque.h). Then adds what a renderer needs
/// and the scene lacks:
///  - tangents where a normal map is used without them (tangents.h);
///  - a camera that shows everything (framing.h), if there is none;
///  - a soft sky (environment.h), if there is no environment and the rule allows it.
/// So set the user's environment before.
void prepare(Scene& scene, SkyRule rule = SkyRule::WithoutLights);

}  // namespace limpid::scene
