#include <utility>

#include "image/color.h"
#include "image/io/row_sums.h"
#include "image/metrics/metrics.h"
#include "image/metrics/metrics_check.h"
#include "image/metrics/separable_filter.h"

namespace limpid::image {
namespace {

constexpr int windowRadius = 5;
constexpr double windowSigma = 1.5;
constexpr double c1 = 0.01 * 0.01;
constexpr double c2 = 0.03 * 0.03;

/// Returns luma - 0.5. Centring reduces cancellation when the squared mean is subtracted from the mean of
/// squares.
Image centredLuma(const Image& image) {
    Image luma(image.width, image.height, 1);
    for (size_t i = 0; i < luma.pixels.size(); ++i) {
        const float* p = &image.pixels[3 * i];
        luma.pixels[i] = luminance(p[0], p[1], p[2]) - 0.5f;
    }
    return luma;
}

Image blurredProduct(const Image& a, const Image& b, const Kernel& window) {
    Image product(a.width, a.height, 1);
    for (size_t i = 0; i < product.pixels.size(); ++i) product.pixels[i] = a.pixels[i] * b.pixels[i];
    return filterSeparably(product, window, window);
}

/// Returns the range of pixels in a row or column whose window lies within it; all pixels if it is shorter
/// than the window.
std::pair<size_t, size_t> insideRange(size_t length) {
    constexpr size_t radius = windowRadius;
    if (length < 2 * radius + 1) return {0, length};
    return {radius, length - radius};
}

}  // namespace

double ssim(const Image& test, const Image& reference) {
    checkComparable(test, reference);
    const Kernel window = gaussianKernel(windowRadius, windowSigma);
    const Image x = centredLuma(test), y = centredLuma(reference);
    const Image meanX = filterSeparably(x, window, window), meanY = filterSeparably(y, window, window);
    const Image meanXX = blurredProduct(x, x, window), meanYY = blurredProduct(y, y, window);
    const Image meanXY = blurredProduct(x, y, window);

    const auto [left, right] = insideRange(test.width);
    const auto [top, bottom] = insideRange(test.height);
    const auto rowSum = [&, left = left, right = right, top = top](size_t row) {
        double sum = 0.0;
        for (size_t column = left; column < right; ++column) {
            const size_t i = (top + row) * test.width + column;
            const double mx = meanX.pixels[i], my = meanY.pixels[i];
            const double varianceX = meanXX.pixels[i] - mx * mx;
            const double varianceY = meanYY.pixels[i] - my * my;
            const double covariance = meanXY.pixels[i] - mx * my;
            const double lumaX = mx + 0.5, lumaY = my + 0.5;
            sum += (2.0 * lumaX * lumaY + c1) * (2.0 * covariance + c2) /
                   ((lumaX * lumaX + lumaY * lumaY + c1) * (varianceX + varianceY + c2));
        }
        return sum;
    };
    return sumRows(bottom - top, rowSum) /
           (static_cast<double>(right - left) * static_cast<double>(bottom - top));
}

}  // namespace limpid::image
