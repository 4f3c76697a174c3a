// Reads portable float maps (.pfm).
// Format: Paul Debevec's, http://www.pauldebevec.com/Research/HDR/PFM/.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "image/image.h"

namespace limpid::image {

/// True if the bytes begin like a portable float map.
bool isPfm(std::span<const std::byte> bytes);

/// Decodes three components ("PF") or one ("Pf"), of either byte order. The file's rows go upwards; its scale
/// is ignored, as is usual. Throws InputError if the bytes are malformed, truncated or too large.
Image decodePfm(std::span<const std::byte> bytes, const std::filesystem::path& name);

}  // namespace limpid::image
