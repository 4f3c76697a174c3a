// What all metrics ask of their arguments. Private to src/image.
#pragma once

#include "image/image.h"

namespace limpid::image {

/// Throws Error unless both have 3 components, the same size, and at least one pixel.
void checkComparable(const Image& test, const Image& reference);

}  // namespace limpid::image
