// Whatever serves as an environment map, in bounded memory.
#pragma once

#include <cstdint>
#include <filesystem>

#include "image/image.h"
#include "image/io/memory_bound.h"

namespace limpid::image {

/// What a pixel of an environment map takes on the host once it is on a device that is a CPU: the picture as
/// floats (12 bytes), then with its probability for the device (16) and the alias table (8), both twice.
inline constexpr uint64_t environmentBytesPerPixel = 12 + 2 * (16 + 8);

/// Linear radiance, 3 components, from .hdr/.pic or .exr (the layer of LayeredImage::colorLayer, or "Y"), by
/// the name's extension. Values that are no radiance (NaN, infinite, negative) become 0, with one warning. A
/// picture that would take more than `maxMemory`, which its header tells, is scaled down to the means of
/// whole cells while its rows are decoded, with a warning. Throws InputError.
Image readEnvironmentImage(const std::filesystem::path& path, uint64_t maxMemory = defaultImageMemory);

}  // namespace limpid::image
