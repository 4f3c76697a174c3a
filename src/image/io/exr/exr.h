// OpenEXR files: every channel of a picture, by name, with string attributes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "image/image.h"

namespace limpid::image {

enum class Compression { None, Rle, Zips, Zip, Piz };

/// Writes all channels and the metadata (as string attributes) in one scanline part, atomically.
/// Half: finite values beyond +-65504 are stored as +-65504; NaN and infinity are stored as they are.
/// Uint: rounded and clamped to 0 .. 2^32-1, NaN becomes 0.
/// Throws OutputError if the file cannot be written; Error if the content makes no file (no channels, a name
/// twice, a channel of the wrong size, metadata named as an attribute that EXR reserves).
void writeExr(const std::filesystem::path& path, const LayeredImage& image,
              Compression compression = Compression::Zip);

/// Reads a scanline or tiled file (highest-resolution level), or the first part of a multi-part file: all its
/// channels whatever their names, in the file's (alphabetical) order, and its string attributes.
/// The result covers the display window, which is the frame that the file stands for: what the data window
/// lacks of it (a cropped render) is 0, what it has beyond (overscan) is left out. Throws InputError if the
/// file is missing, malformed, truncated or incomplete, too large (image/io/limits.h), deep, or has
/// subsampled channels.
LayeredImage readExr(const std::filesystem::path& path);

/// readExr for bytes in memory; `name` stands for the file in messages.
LayeredImage decodeExr(std::span<const std::byte> bytes, const std::filesystem::path& name);

}  // namespace limpid::image
