// Which parts of a scene move under a clip. Packing (scene/device/scene_data.h) follows it: what stays still
// shares one tree.
#pragma once

#include <string>
#include <string_view>

#include "scene/model/scene.h"

namespace limpid::scene {

/// Chooses the clip that plays, by name or by number from 0; "" the first; "all" all together, as one clip
/// that is added to the rig. Sets Scene::clip and every Instance::movement; a camera made by framing.h shows
/// all of the movement from then on. Throws UsageError listing the clips if there is no such one.
void chooseClip(Scene& scene, std::string_view choice);

/// What chooseClip() takes to choose the same in a scene of the same file; "" if no clip plays.
std::string clipChoice(const Scene& scene);

}  // namespace limpid::scene
