// Colours as video has them: BT.709, limited range, one chroma sample for four pixels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "studio/picture.h"

namespace limpid::serve {

/// One plane of a picture, in the caller's memory.
struct Plane {
    uint8_t* data = nullptr;
    size_t stride = 0;  ///< bytes from one row to the next
};

/// Y'CbCr = M R'G'B' as in ITU-R BT.709-6, item 3.3 and 3.4, rounded: Y' from 16 to 235, Cb and Cr from 16 to
/// 240. The chroma of two by two pixels is that of their mean. `planes`: Y', and Cb and Cr of half the size,
/// rounded up. Uses several threads.
void toYuv420(const studio::Picture& picture, const Plane& y, const Plane& cb, const Plane& cr);

/// The inverse, with the nearest chroma sample; opaque. For tests and measurements.
studio::Picture fromYuv420(gpu::Extent extent, const Plane& y, const Plane& cb, const Plane& cr);

}  // namespace limpid::serve
