// TGA and BMP through stb_image. Private to src/image.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "image/io/memory_bound.h"
#include "image/io/png/png.h"

namespace limpid::image {

/// By a TGA file's header, which has no magic number: one of its six kinds, with a pixel size that fits it.
bool looksLikeTga(std::span<const std::byte> bytes);
bool looksLikeBmp(std::span<const std::byte> bytes);

/// Everything that can be known before a pixel is decoded: stb_image takes what a file lacks for zeros.
/// Throws InputError if it is of a kind that is not read, too large, or cut off.
PictureSize checkTgaOrBmp(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// RGBA. Only after checkTgaOrBmp(). Throws InputError.
ByteImage decodeTgaOrBmp(std::span<const std::byte> bytes, const std::filesystem::path& name);

}  // namespace limpid::image
