// Limits on the sizes that a picture file may claim: a few hundred bytes must not cause gigabytes to be
// allocated.
#pragma once

#include <cstdint>
#include <filesystem>

namespace limpid::image {

/// The largest accepted width * height of a picture.
inline constexpr uint64_t maxPixels = uint64_t{1} << 28;
/// The limit for pictures that are scaled down row by row, which only costs time.
inline constexpr uint64_t maxStreamedPixels = uint64_t{1} << 30;
/// Deflate compresses at most 1032 bytes, of 8 one-bit pixels each, into one.
inline constexpr uint64_t pngPixelsPerByte = 8 * 1032;

/// Throws InputError(file) unless 0 < width * height <= `most` and a file of `fileBytes` can contain that
/// many pixels. `pixelsPerByte` is the highest compression that the format allows, or that is plausible.
void checkDimensions(const std::filesystem::path& file, uint64_t width, uint64_t height, uint64_t fileBytes,
                     uint64_t pixelsPerByte, uint64_t most = maxPixels);

}  // namespace limpid::image
