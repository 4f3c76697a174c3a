// Determines which parts of a scene a clip moves. Packing (scene/device/scene_data.h) relies on it: static
// parts share one tree.
#pragma once

#include <string>
#include <string_view>

#include "scene/model/scene.h"

namespace limpid::scene {

/// Chooses the clip that plays, by name or by number from 0. "" is the first; "all" plays all clips together,
/// as one clip that is added to the rig. Sets Scene::clip and every Instance::movement; a camera made by
/// framing.h is adapted to show the whole movement. Throws UsageError listing the clips if there is no such
/// clip.
void chooseClip(Scene& scene, std::string_view choice);

/// Returns the argument for chooseClip() that selects the same clip in a scene from the same file; "" if no
/// clip plays.
std::string clipChoice(const Scene& scene);

}  // namespace limpid::scene
