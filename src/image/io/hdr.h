// Reads Radiance pictures (.hdr, .pic).
// Format: Greg Ward, "Real Pixels", Graphics Gems II, 1991, and the Radiance file format notes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "image/image.h"
#include "image/io/rows/row_sink.h"

namespace limpid::image {

/// Decodes RGBE with any of its three encodings (flat, old runs, per-component runs) into 3 linear
/// components. Mantissa m and exponent e stand for m * 2^(e-136), as in Walter's rgbe.c and stb_image (not
/// Ward's m + 0.5). Divides by the header's EXPOSURE values, as the format requires. Reads both vertical
/// orders; rejects rotated and mirrored pictures and XYZE. Throws InputError if the bytes are malformed,
/// truncated or too large.
Image decodeHdr(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// Like decodeHdr(), but reads a file.
Image readHdr(const std::filesystem::path& path);

/// Like decodeHdr(), but row by row in the file's order. Accepts at most `most` pixels.
void decodeHdrRows(std::span<const std::byte> bytes, const std::filesystem::path& name, const RowSink& sink,
                   uint64_t most);

}  // namespace limpid::image
