// Scene files of any format to a Scene.
#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace limpid::scene {

/// Loads .gltf, .glb or .obj, by the name's extension (upper or lower case). The result keeps all invariants
/// of scene.h (validate.h checks them) but may lack a camera and light: see prepare.h. Throws InputError with
/// the file's name and the fault; what is merely odd is a warning in the log.
Scene loadScene(const std::filesystem::path& path);

}  // namespace limpid::scene
