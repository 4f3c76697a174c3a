// Picture files as textures: 8-bit RGBA, in bounded memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>

#include "image/io/memory_bound.h"
#include "image/io/png/png.h"

namespace limpid::image {

struct TextureDecoding {
    bool srgb = true;        ///< RGB values are sRGB-encoded: they are scaled down in linear light
    bool tgaAndBmp = false;  ///< besides PNG and JPEG
    uint64_t maxMemory = defaultImageMemory;
    uint64_t maxTexels = std::numeric_limits<uint64_t>::max();  ///< mip levels included
};

/// What a texel of a texture takes on the host once it has mip levels and is on a device that is a CPU: its
/// bytes, a third more with mip levels for the device, twice, and floats while those are made.
inline constexpr uint64_t textureBytesPerTexel = 16;

/// As decodeImage(), but a picture that would take more than `maxMemory`, which its header tells, is scaled
/// down by a whole number while its rows are decoded, with a warning: PNG by means in linear light; JPEG in
/// its cosine transform, by 2, 4 or 8. TGA, BMP, interlaced PNG and progressive JPEG (beyond its
/// coefficients) cannot be, and are refused then. Throws InputError.
ByteImage decodeTexture(std::span<const std::byte> bytes, const std::filesystem::path& name,
                        const TextureDecoding& how);

}  // namespace limpid::image
