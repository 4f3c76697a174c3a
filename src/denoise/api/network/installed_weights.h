// The weights that come with the library.
#pragma once

#include <filesystem>

#include "denoise/kpcn/kpcn.h"

namespace limpid::denoise {

/// kpcn.safetensors, or kpcn-cis565.safetensors if `settings.cis565`: in the folder of the library (or of the
/// program that this is linked into), else where `cmake --install` puts it. Throws InputError if it is at
/// neither place.
std::filesystem::path installedWeights(const KpcnSettings& settings);

}  // namespace limpid::denoise
