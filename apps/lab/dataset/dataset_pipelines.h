// Lets scenes share the pipelines that trace them: a driver may take longer to compile one than to render a
// clip.
#pragma once

#include "scene/device/scene_data.h"

namespace limpid::cli {

/// Makes scenes more alike. It turns on code that their materials never reach; the tables that it reads may
/// be empty.
/// @param lightsToo  also code for kinds of light that the scene does not have
void generalise(scene::SceneData& data, bool lightsToo);

}  // namespace limpid::cli
