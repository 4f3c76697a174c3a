// Which parts of a scene move under a clip. Packing (scene/scene_data.h) follows it: what stays still shares
// one tree.
#pragma once

#include <string_view>

#include "scene/scene.h"

namespace limpid::scene {

/// Chooses the clip that plays, by name or by number from 0; "" the first. Sets Scene::clip and every
/// Instance::movement; a camera made by framing.h shows all of the movement from then on. Throws UsageError
/// listing the clips if there is no such one.
void chooseClip(Scene& scene, std::string_view choice);

}  // namespace limpid::scene
