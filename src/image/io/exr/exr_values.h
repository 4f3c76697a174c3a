// Conversions between floats and the types in which EXR files store values. Private to src/image.
#pragma once

#include <ImfPixelType.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/error.h"
#include "image/image.h"

namespace limpid::image {

inline Imf::PixelType toImf(Storage storage) {
    switch (storage) {
        case Storage::Half:
            return Imf::HALF;
        case Storage::Float:
            return Imf::FLOAT;
        case Storage::Uint:
            return Imf::UINT;
    }
    throw Error("unknown EXR storage");
}

inline Storage storageOf(Imf::PixelType type) {
    if (type == Imf::HALF) return Storage::Half;
    return type == Imf::UINT ? Storage::Uint : Storage::Float;
}

inline half toHalf(float value) {
    constexpr float largest = 65504.0f;
    // A bright but finite pixel must not become infinite.
    return half(std::isfinite(value) ? std::clamp(value, -largest, largest) : value);
}

inline uint32_t toUint(float value) {
    if (!(value > 0.0f)) return 0;
    return value >= 4294967296.0f ? std::numeric_limits<uint32_t>::max()
                                  : static_cast<uint32_t>(std::llround(static_cast<double>(value)));
}

}  // namespace limpid::image
