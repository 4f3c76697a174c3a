// Reads and writes PNG and JPEG pictures: writes 8 bits per component, reads 8 or 16. All values are as
// encoded in the file (sRGB for colour); image/color.h has the transfer functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "image/image.h"

namespace limpid::image {

/// Interleaved 8-bit components, row 0 at the top.
struct ByteImage {
    uint32_t width = 0;
    uint32_t height = 0;
    uint32_t components = 4;  ///< 3 (RGB) or 4 (RGBA)
    std::vector<uint8_t> pixels;
};

/// Converts encoded values to bytes: [0,1] to 0..255, rounded and clamped; NaN becomes 0. `encoded` has 3 or
/// 4 components, or 1, which becomes grey. Throws Error otherwise.
ByteImage toBytes(const Image& encoded);

/// Returns the bytes of an 8-bit RGB or RGBA PNG. `name` is used in messages. Throws OutputError.
std::vector<char> encodePng(const ByteImage& image, const std::filesystem::path& name);

/// Writes an 8-bit RGB or RGBA PNG, atomically. Throws OutputError.
void writePng(const std::filesystem::path& path, const ByteImage& image);

/// Decodes a PNG or JPEG to 8-bit RGBA (16-bit files lose their low byte; grey becomes RGB; missing alpha
/// becomes 255). `name` is used in messages. Throws InputError if the bytes are neither, are damaged or
/// truncated (checks PNG checksums and JPEG markers), or claim more pixels than they can hold or
/// image/io/rows/limits.h allows.
ByteImage decodeImage(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// Like decodeImage(), but reads a file.
ByteImage readPngOrJpeg(const std::filesystem::path& path);

/// Like decodeImage(), but returns encoded floats in [0,1], 4 components, keeping all 16 bits of a 16-bit
/// PNG.
Image decodeImageFloat(std::span<const std::byte> bytes, const std::filesystem::path& name);

}  // namespace limpid::image
