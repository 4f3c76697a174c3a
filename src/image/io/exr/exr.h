// Reads and writes OpenEXR files: all channels of a picture by name, and string attributes.
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
/// Throws OutputError if the file cannot be written; Error if the content is invalid (no channels, a
/// duplicate name, a channel of the wrong size, metadata with the name of an attribute that EXR reserves).
void writeExr(const std::filesystem::path& path, const LayeredImage& image,
              Compression compression = Compression::Zip);

/// Reads a scanline or tiled file (highest-resolution level), or the first part of a multi-part file: all its
/// channels in the file's (alphabetical) order, and its string attributes. The result covers the display
/// window. Pixels that the data window lacks (a cropped render) are 0; pixels outside the display window
/// (overscan) are dropped. Throws InputError if the file is missing, malformed, truncated or incomplete, too
/// large (image/io/rows/limits.h), deep, or has subsampled channels.
LayeredImage readExr(const std::filesystem::path& path);

/// Like readExr(), but for bytes in memory; `name` is used in messages.
LayeredImage decodeExr(std::span<const std::byte> bytes, const std::filesystem::path& name);

}  // namespace limpid::image
