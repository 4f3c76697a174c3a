// Loads scene files of any supported format.
#pragma once

#include <filesystem>

#include "scene/load/load_options.h"
#include "scene/model/scene.h"

namespace limpid::scene {

/// Loads .gltf, .glb or .obj, chosen by the name's extension (upper or lower case). The result satisfies all
/// invariants of scene.h (checked by validate.h) but may lack a camera and light: see prepare.h. Throws
/// InputError with the file's name and the fault. Lesser faults are logged as warnings. So are textures that
/// cannot be read; the material then has a plain colour.
Scene loadScene(const std::filesystem::path& path, const LoadOptions& options = {});

}  // namespace limpid::scene
