// The two ways that a picture with radiance takes into the program.
#pragma once

#include <filesystem>

namespace limpid::fuzz {

/// Reads it as an environment map, packs that for the device, and reads it as a picture to compare. False if
/// either way refuses it.
bool readsAsRadiance(const std::filesystem::path& path);

}  // namespace limpid::fuzz
