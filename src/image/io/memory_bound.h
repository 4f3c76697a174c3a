// How much memory one picture may take on the host, and by how much it is scaled down to stay below.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>

namespace limpid::image {

/// What --max-image-memory is by default.
inline constexpr uint64_t defaultImageMemory = uint64_t{2} << 30;

struct PictureSize {
    uint32_t width = 0, height = 0;
    uint64_t pixels() const { return uint64_t{width} * height; }
};

/// Every `reduction` pixels along each axis become one; the last ones take what is left over, as in mip
/// levels.
inline PictureSize reduced(PictureSize size, uint32_t reduction) {
    return {std::max(1u, size.width / reduction), std::max(1u, size.height / reduction)};
}

/// Whether a picture of this size, once scaled down, stays below the bound.
using Fits = std::function<bool(PictureSize)>;

/// The smallest reduction that fits; above 1 with a warning. Throws InputError if not even one pixel does.
/// `maxMemory` is for the message.
uint32_t reductionFor(const std::filesystem::path& name, PictureSize size, const Fits& fits,
                      uint64_t maxMemory);

/// For pictures that cannot be scaled down while they are decoded: throws InputError, saying `why`, unless
/// the picture fits as it is.
void requireFits(const std::filesystem::path& name, PictureSize size, const Fits& fits, uint64_t maxMemory,
                 const char* why);

/// The warning of both the above and JPEG, which scales itself.
void warnReduced(const std::filesystem::path& name, PictureSize from, PictureSize to, uint64_t maxMemory);

}  // namespace limpid::image
