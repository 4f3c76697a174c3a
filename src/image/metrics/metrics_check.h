// Checks of the metrics' arguments, and their treatment of invalid pixels. Private to src/image.
#pragma once

#include <cstddef>
#include <vector>

#include "image/image.h"

namespace limpid::image {

/// Throws Error unless both have 3 components, the same size, and at least one pixel.
void checkComparable(const Image& test, const Image& reference);

/// Returns the indices of the pixels with a NaN or an infinity, ascending. The image has 3 components.
std::vector<size_t> invalidPixels(const Image& image);

/// Throws Error if the reference has invalid pixels.
void checkReferenceValid(const Image& reference);

/// Sets each component of these pixels of a display-encoded test picture to 0 or 1, whichever is farther from
/// the display-encoded reference.
void showAsWorst(const std::vector<size_t>& pixels, const Image& shownReference, Image& shownTest);

}  // namespace limpid::image
