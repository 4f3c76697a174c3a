// Separable filters over pictures of one component, for the metrics. Private to src/image.
#pragma once

#include <vector>

#include "image/image.h"

namespace limpid::image {

/// Weights at -radius .. radius; the size is 2 * radius + 1.
using Kernel = std::vector<double>;

/// exp(-x^2 / (2 sigma^2)) for x = -radius .. radius, scaled to the sum 1.
Kernel gaussianKernel(int radius, double sigma);

/// out(x,y) = sum over i, j of horizontal[i] * vertical[j] * in(x + i, y + j), for i and j from -radius to
/// radius; pixels beyond the border repeat those at the border. Sums are kept in double, so that a constant
/// picture stays what it was to the last bit (with kernels of sum 1). `in` has one component.
Image filterSeparably(const Image& in, const Kernel& horizontal, const Kernel& vertical);

}  // namespace limpid::image
