// How a scene is loaded: limits on the files that it may read and on the memory for each picture, and who
// watches.
#pragma once

#include <cstdint>
#include <filesystem>

#include "base/progress.h"
#include "image/io/rows/memory_bound.h"

namespace limpid::scene {

struct LoadOptions {
    /// Files that the scene refers to must lie in this folder or in the scene's own; empty: only in its own.
    std::filesystem::path assetRoot;
    /// Host memory for one picture, from the file's bytes to mip levels and tables. Larger pictures are
    /// scaled down while they are decoded.
    uint64_t maxImageMemory = image::defaultImageMemory;
    Progress progress = {};
};

/// Returns the asset root for a scene that the user names: the parent of the scene's folder, so that
/// "../textures/wood.png" works; but the scene's own folder if the parent is "/" or contains home folders.
std::filesystem::path defaultAssetRoot(const std::filesystem::path& sceneFile);

}  // namespace limpid::scene
