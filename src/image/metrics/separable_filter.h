// Separable filters for images of one component, used by the metrics. Private to src/image.
#pragma once

#include <vector>

#include "image/image.h"

namespace limpid::image {

/// Weights at -radius .. radius, 2 * radius + 1 of them.
using Kernel = std::vector<double>;

/// Returns exp(-x^2 / (2 sigma^2)) for x = -radius .. radius, scaled to a sum of 1.
Kernel gaussianKernel(int radius, double sigma);

/// Returns out(x,y) = sum over i, j of horizontal[i] * vertical[j] * in(x + i, y + j), for i and j from
/// -radius to radius. The border is repeated beyond the image. Sums are in double precision, so that a kernel
/// of sum 1 leaves a constant image unchanged to the last bit. `in` has one component.
Image filterSeparably(const Image& in, const Kernel& horizontal, const Kernel& vertical);

}  // namespace limpid::image
