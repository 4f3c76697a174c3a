// Reads and writes files with edits to a scene's lights, for --lights: the window writes them, `limpid
// render` reads them.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "scene/lights/light_control.h"

namespace limpid::scene {

/// Returns JSON (docs/viewer.md) with the lights of `controls` that differ from `before`.
std::string lightFileText(std::span<const LightControl> controls, std::span<const LightControl> before);

/// Returns `before` with the file's edits. Throws InputError if it is not such a file, names a light that the
/// scene does not have, or has invalid values.
std::vector<LightControl> readLightFile(const std::filesystem::path& file, std::vector<LightControl> before);

}  // namespace limpid::scene
