// Reads environment maps of any supported format, in bounded memory.
#pragma once

#include <cstdint>
#include <filesystem>

#include "image/image.h"
#include "image/io/rows/memory_bound.h"

namespace limpid::image {

/// Host memory per pixel of an environment map on a CPU device: the picture as floats (12 bytes); the pixels
/// with their probability (16) and the alias table (8) for the device, both twice.
inline constexpr uint64_t environmentBytesPerPixel = 12 + 2 * (16 + 8);

/// Reads linear radiance, 3 components, from .hdr/.pic or .exr (the layer of LayeredImage::colorLayer, or
/// "Y"), chosen by the name's extension. Invalid radiance (NaN, infinite, negative) becomes 0, with one
/// warning. If the header shows that the picture would take more than `maxMemory`, it is scaled down while
/// its rows are decoded, with a warning: each result pixel is the mean of a whole cell. Throws InputError.
Image readEnvironmentImage(const std::filesystem::path& path, uint64_t maxMemory = defaultImageMemory);

}  // namespace limpid::image
