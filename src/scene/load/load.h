// Loads scene files of any supported format.
#pragma once

#include <filesystem>

#include "scene/load/load_options.h"
#include "scene/model/scene.h"

namespace limpid::scene {

/// Whether loadScene() takes a file of this name: .gltf, .glb or .obj, in upper or lower case.
bool isSceneFile(const std::filesystem::path& path);

/// Loads a scene file, of the format that the name's extension says. The result satisfies all
/// invariants of scene.h (checked by validate.h) but may lack a camera and light: see prepare.h. Throws
/// InputError with the file's name and the fault. Lesser faults are logged as warnings. So are textures that
/// cannot be read; the material then has a plain colour.
Scene loadScene(const std::filesystem::path& path, const LoadOptions& options = {});

}  // namespace limpid::scene
