// Reads JPEG with libjpeg-turbo. Private to src/image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

#include "image/io/png/png.h"
#include "image/io/rows/memory_bound.h"

namespace limpid::image {

/// Returns RGBA. Throws InputError if the bytes are not a JPEG, are damaged, claim more pixels than they can
/// hold, or have more scans than a picture needs.
ByteImage decodeJpeg(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// Decides how much a JPEG is scaled down.
struct JpegBound {
    bool isBuffered = false;  ///< all coefficients are held in memory before a row is decoded: see
                              ///< checkJpeg()
    std::function<Fits(uint64_t beside)> fits;  ///< gets the bytes that decoding needs besides the pixels
    uint64_t maxMemory = defaultImageMemory;
};

/// Like above, but scaled down by 2, 4 or 8 during the inverse cosine transform if the bound requires it,
/// with a warning.
ByteImage decodeJpeg(std::span<const std::byte> bytes, const std::filesystem::path& name,
                     const JpegBound& bound);

}  // namespace limpid::image
