// The pixel at a position in a picture.
#pragma once

#include <algorithm>
#include <cstdint>

namespace limpid::studio {

/// Column or row: `share` from 0 to 1 of `length` pixels, which must be at least 1.
inline uint32_t pixelAt(float share, uint32_t length) {
    const float at = std::clamp(share, 0.0f, 1.0f) * static_cast<float>(length);
    return std::min(static_cast<uint32_t>(at), length - 1);
}

}  // namespace limpid::studio
