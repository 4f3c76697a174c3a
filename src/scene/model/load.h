// Scene files of any format to a Scene.
#pragma once

#include <filesystem>

#include "scene/model/load_options.h"
#include "scene/model/scene.h"

namespace limpid::scene {

/// Loads .gltf, .glb or .obj, by the name's extension (upper or lower case). The result keeps all invariants
/// of scene.h (validate.h checks them) but may lack a camera and light: see prepare.h. Throws InputError with
/// the file's name and the fault; what is merely odd is a warning in the log, as is a texture that cannot be
/// had: the material then has a plain colour there.
Scene loadScene(const std::filesystem::path& path, const LoadOptions& options = {});

}  // namespace limpid::scene
