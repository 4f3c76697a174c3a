// What all metrics ask of their arguments, and what they do with pixels that are no colour. Private to
// src/image.
#pragma once

#include <cstddef>
#include <vector>

#include "image/image.h"

namespace limpid::image {

/// Throws Error unless both have 3 components, the same size, and at least one pixel.
void checkComparable(const Image& test, const Image& reference);

/// Pixels of an image of 3 components with a NaN or an infinity, ascending.
std::vector<size_t> invalidPixels(const Image& image);

/// Throws Error if the reference has such pixels: there is no truth to compare with.
void checkReferenceValid(const Image& reference);

/// Sets these pixels of a displayed test picture to black or white in each component, whichever is farther
/// from the displayed reference.
void showAsWorst(const std::vector<size_t>& pixels, const Image& shownReference, Image& shownTest);

}  // namespace limpid::image
