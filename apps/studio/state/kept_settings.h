// What the window remembers from one time to the next.
#pragma once

#include <filesystem>

#include "studio/settings.h"

namespace limpid::studio {

/// limpid/view.json in $XDG_CONFIG_HOME, or in ~/.config; empty where there is neither.
std::filesystem::path keptSettingsFile();

/// Integrator, denoiser, samples, resolution and every parameter, into `settings`. A file that is missing,
/// damaged or of another version is nothing: what it says and Limpid does not know is left out, with a
/// warning.
void restoreSettings(const std::filesystem::path& file, StudioSettings& settings);

/// The settings that start a studio with this state.
StudioSettings settingsOf(const State& state, StudioSettings settings);

/// Throws OutputError.
void keepSettings(const std::filesystem::path& file, const StudioSettings& settings);

}  // namespace limpid::studio
