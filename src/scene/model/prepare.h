// The last step between a loader, or a built-in scene, and rendering.
#pragma once

#include "scene/model/scene.h"

namespace limpid::scene {

/// When a scene without an environment gets a soft sky.
enum class SkyRule {
    Never,          ///< black was asked for
    WithoutLights,  ///< no punctual light, and no emissive material in use
    InTheDark,      ///< as well if its lights leave most of what the first camera sees black (light_reach.h)
};
/// `InTheDark`: at least this share of the pixels that see a surface.
inline constexpr double darkShareForSky = 0.75;

/// Checks the invariants of scene.h and throws Error with the first that is broken (validate.h). Then adds
/// what a renderer needs and the scene lacks:
///  - tangents where a normal map is used without them (tangents.h);
///  - a camera that shows everything (framing.h), if there is none;
///  - a soft sky (environment.h), if there is no environment and the rule says so.
/// So an environment of the user's must be set before.
void prepare(Scene& scene, SkyRule rule = SkyRule::WithoutLights);

}  // namespace limpid::scene
