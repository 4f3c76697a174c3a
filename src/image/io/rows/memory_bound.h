// Bounds the host memory of one picture, and computes how far it must be scaled down.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>

namespace limpid::image {

/// The default of --max-image-memory.
inline constexpr uint64_t defaultImageMemory = uint64_t{2} << 30;

struct PictureSize {
    uint32_t width = 0, height = 0;
    uint64_t pixels() const { return uint64_t{width} * height; }
};

/// Averages `reduction` pixels into one along each axis; the last ones include the remainder, as in mip
/// levels.
inline PictureSize reduced(PictureSize size, uint32_t reduction) {
    return {std::max(1u, size.width / reduction), std::max(1u, size.height / reduction)};
}

/// Returns true if a picture of this (reduced) size is within the bound.
using Fits = std::function<bool(PictureSize)>;

/// Returns the smallest reduction that fits; warns if it is above 1. Throws InputError if not even one pixel
/// fits. `maxMemory` is for the message.
uint32_t reductionFor(const std::filesystem::path& name, PictureSize size, const Fits& fits,
                      uint64_t maxMemory);

/// For pictures that cannot be scaled down while decoding: throws InputError with the reason `why` if the
/// picture does not fit at full size.
void requireFits(const std::filesystem::path& name, PictureSize size, const Fits& fits, uint64_t maxMemory,
                 const char* why);

/// The warning about a reduced picture, also for JPEG, which does its own scaling.
void warnReduced(const std::filesystem::path& name, PictureSize from, PictureSize to, uint64_t maxMemory);

}  // namespace limpid::image
