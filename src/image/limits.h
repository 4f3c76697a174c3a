// What a picture file may claim before Limpid believes it. A few hundred bytes must not allocate gigabytes.
#pragma once

#include <cstdint>
#include <filesystem>

namespace limpid::image {

/// The largest accepted width * height of a picture.
inline constexpr uint64_t maxPixels = uint64_t{1} << 28;

/// Throws InputError(file) unless 0 < width * height <= maxPixels and a file of `fileBytes` can hold that
/// many pixels: `pixelsPerByte` is the highest compression that the format allows, or that is plausible.
void checkDimensions(const std::filesystem::path& file, uint64_t width, uint64_t height, uint64_t fileBytes,
                     uint64_t pixelsPerByte);

}  // namespace limpid::image
