// Changes to a scene's lights in a file, for --lights: what the window writes and `limpid render` reads.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "scene/model/light_control.h"

namespace limpid::scene {

/// JSON (docs/viewer.md): the lights of `controls` that are not as `before`.
std::string lightFileText(std::span<const LightControl> controls, std::span<const LightControl> before);

/// `before` with what the file changes. Throws InputError: not such a file, a light that the scene has not,
/// or values that no light can have.
std::vector<LightControl> readLightFile(const std::filesystem::path& file, std::vector<LightControl> before);

}  // namespace limpid::scene
