// Radiance pictures (.hdr, .pic), and whatever serves as an environment map.
// Format: Greg Ward, "Real Pixels", Graphics Gems II, 1991, and the Radiance file format notes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "image/image.h"

namespace limpid::image {

/// Decodes RGBE with any of its three encodings (flat, old runs, per-component runs) into 3 linear
/// components. mantissa m and exponent e stand for m * 2^(e-136), as in Walter's rgbe.c and stb_image (not
/// Ward's m + 0.5). EXPOSURE lines of the header are divided out, as the format asks. Both vertical orders
/// are read; rotated and mirrored pictures and XYZE are refused. Throws InputError if the bytes are
/// malformed, truncated or too large.
Image decodeHdr(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// decodeHdr for a file.
Image readHdr(const std::filesystem::path& path);

/// Linear radiance, 3 components, from .hdr/.pic or .exr (the layer of LayeredImage::colorLayer, or "Y"), by
/// the name's extension. Values that are no radiance (NaN, infinite, negative) become 0, with one warning.
/// Throws InputError.
Image readEnvironmentImage(const std::filesystem::path& path);

}  // namespace limpid::image
