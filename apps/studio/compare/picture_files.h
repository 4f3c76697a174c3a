// Pictures in the window as files.
#pragma once

#include <filesystem>
#include <string>

#include "studio/live/live_render.h"

namespace limpid::studio {

/// In the working folder: with a number where there is a file of that name already.
std::filesystem::path unusedFile(const std::string& stem, const std::string& extension);

/// The last frame: .exr is linear, with all layers of its pipeline if its settings have layers; anything else
/// is a PNG, exposed by `stops` and encoded by the tone curve. Throws OutputError.
void savePicture(const std::filesystem::path& file, LiveRender& picture, float stops, image::ToneCurve curve);

}  // namespace limpid::studio
