// What may be read on behalf of a scene file, and how much memory a picture of it may take.
#pragma once

#include <cstdint>
#include <filesystem>

#include "image/io/memory_bound.h"

namespace limpid::scene {

struct LoadOptions {
    /// Files that the scene names must lie in this folder or in the scene's own; empty: in its own only.
    std::filesystem::path assetRoot;
    /// Host memory for one picture, from the file's bytes to mip levels and tables. Larger pictures are
    /// scaled down while they are decoded.
    uint64_t maxImageMemory = image::defaultImageMemory;
};

/// The asset root of a scene that the user names: the folder above the scene's own, so that
/// "../textures/wood.png" works; but the scene's own folder if the one above is "/" or holds home folders.
std::filesystem::path defaultAssetRoot(const std::filesystem::path& sceneFile);

}  // namespace limpid::scene
