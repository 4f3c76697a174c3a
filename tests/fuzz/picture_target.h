// The two ways in which the program reads a picture with radiance.
#pragma once

#include <filesystem>

namespace limpid::fuzz {

/// Reads the picture as an environment map and packs that for the device; then reads it as a picture to
/// compare. Returns false if either is refused.
bool readsAsRadiance(const std::filesystem::path& path);

}  // namespace limpid::fuzz
