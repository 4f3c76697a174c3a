// Loads glTF 2.0 files (.gltf, .glb) as a Scene, in the rest pose. gltf_document.h, gltf_mesh.h,
// gltf_material.h and gltf_animation.h say what is supported.
#pragma once

#include <filesystem>

#include "scene/load/load_options.h"
#include "scene/model/scene.h"

namespace limpid::scene::gltf {

/// Throws InputError with the file and the fault. Memory is bounded by the limits of the parts
/// (gltf_access.h, gltf_mesh.h, texture_pool.h, scene_files.h) and `maxInstances`; time by the document's
/// size and those limits.
Scene load(const std::filesystem::path& file, const LoadOptions& options = {});

inline constexpr size_t maxInstances = size_t{1} << 20;

}  // namespace limpid::scene::gltf
