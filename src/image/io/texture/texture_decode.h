// Decodes picture files as textures: 8-bit RGBA, in bounded memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>

#include "image/io/png/png.h"
#include "image/io/rows/memory_bound.h"

namespace limpid::image {

struct TextureDecoding {
    bool srgb = true;        ///< RGB values are sRGB-encoded: scaling down uses linear light
    bool tgaAndBmp = false;  ///< accepted besides PNG and JPEG
    uint64_t maxMemory = defaultImageMemory;
    uint64_t maxTexels = std::numeric_limits<uint64_t>::max();  ///< including mip levels
};

/// Host memory per texel of a texture with mip levels on a CPU device: its bytes and a third more for mip
/// levels, twice, and floats while those are made.
inline constexpr uint64_t textureBytesPerTexel = 16;

/// Like decodeImage(), but if the header shows that the picture would take more than `maxMemory`, it is
/// scaled down by an integer factor while its rows are decoded, with a warning: PNG by means in linear light;
/// JPEG in its cosine transform, by 2, 4 or 8. TGA, BMP, interlaced PNG and progressive JPEG (beyond its
/// coefficients) cannot be scaled and are rejected if too large. Throws InputError.
ByteImage decodeTexture(std::span<const std::byte> bytes, const std::filesystem::path& name,
                        const TextureDecoding& how);

}  // namespace limpid::image
