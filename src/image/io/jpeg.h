// JPEG through libjpeg-turbo. Private to src/image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

#include "image/io/memory_bound.h"
#include "image/io/png/png.h"

namespace limpid::image {

/// RGBA. Throws InputError if it is no JPEG, is damaged in any way, claims more pixels than its bytes can
/// hold, or has more scans than a picture needs.
ByteImage decodeJpeg(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// What decides by how much a JPEG is scaled down.
struct JpegBound {
    bool isBuffered = false;  ///< all coefficients are held before a row is decoded: see checkJpeg()
    std::function<Fits(uint64_t beside)> fits;  ///< given the bytes that decoding takes beside the pixels
    uint64_t maxMemory = defaultImageMemory;
};

/// The same, scaled down by 2, 4 or 8 in the cosine transform where the bound asks for it, with a warning.
ByteImage decodeJpeg(std::span<const std::byte> bytes, const std::filesystem::path& name,
                     const JpegBound& bound);

}  // namespace limpid::image
