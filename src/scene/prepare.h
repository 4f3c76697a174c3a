// The last step between a loader, or a built-in scene, and rendering.
#pragma once

#include "scene/scene.h"

namespace limpid::scene {

/// Checks the invariants of scene.h and throws Error with the first that is broken (validate.h). Then adds
/// what a renderer needs and the scene lacks:
///  - tangents where a normal map is used without them (tangents.h);
///  - a camera that shows everything (framing.h), if there is none;
///  - a soft sky (environment.h), if there is no environment, no punctual light and no emissive material in
///  use.
/// So an environment of the user's must be set before.
void prepare(Scene& scene);

}  // namespace limpid::scene
