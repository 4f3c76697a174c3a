// Reads TGA and BMP with stb_image. Private to src/image.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "image/io/png/png.h"
#include "image/io/rows/memory_bound.h"

namespace limpid::image {

/// Recognises a TGA file by its header, since it has no magic number: one of the six types, with a matching
/// pixel size.
bool looksLikeTga(std::span<const std::byte> bytes);
bool looksLikeBmp(std::span<const std::byte> bytes);

/// Checks everything that can be known before decoding, since stb_image replaces missing data by zeros.
/// Throws InputError if the file's type is not supported, or it is too large or truncated.
PictureSize checkTgaOrBmp(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// Returns RGBA. Call checkTgaOrBmp() first. Throws InputError.
ByteImage decodeTgaOrBmp(std::span<const std::byte> bytes, const std::filesystem::path& name);

}  // namespace limpid::image
