#include "image/metrics/metrics.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "image/color.h"
#include "image/io/row_sums.h"
#include "image/metrics/metrics_check.h"

namespace limpid::image {
namespace {

constexpr float largestHalf = 65504.0f;

bool invalid(const Image& image, size_t pixel) {
    const float* p = &image.pixels[3 * pixel];
    return !std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]);
}

/// Returns the mean of term(i) over the indices i of all values of an image.
template <typename Term>
double meanOverValues(const Image& image, const Term& term) {
    const size_t rowValues = size_t{image.width} * image.components;
    const double sum = sumRows(image.height, [&](size_t y) {
        double rowSum = 0.0;
        for (size_t i = y * rowValues; i < (y + 1) * rowValues; ++i) rowSum += term(i);
        return rowSum;
    });
    return sum / static_cast<double>(image.pixels.size());
}

}  // namespace

std::vector<size_t> invalidPixels(const Image& image) {
    std::vector<size_t> found;
    for (size_t i = 0; i < size_t{image.width} * image.height; ++i) {
        if (invalid(image, i)) found.push_back(i);
    }
    return found;
}

void checkReferenceValid(const Image& reference) {
    if (const size_t count = invalidPixels(reference).size(); count > 0) {
        throw Error(fmt::format("the reference has {} pixels that are NaN or infinite", count));
    }
}

void showAsWorst(const std::vector<size_t>& pixels, const Image& shownReference, Image& shownTest) {
    for (const size_t pixel : pixels) {
        for (size_t i = 3 * pixel; i < 3 * pixel + 3; ++i)
            shownTest.pixels[i] = shownReference.pixels[i] < 0.5f ? 1.0f : 0.0f;
    }
}

void checkComparable(const Image& test, const Image& reference) {
    if (test.width != reference.width || test.height != reference.height) {
        throw Error(fmt::format("a picture of {}x{} cannot be compared with one of {}x{}", test.width,
                                test.height, reference.width, reference.height));
    }
    if (test.components != 3 || reference.components != 3)
        throw Error("only pictures of 3 components are compared");
    if (test.pixels.empty()) throw Error("pictures without pixels cannot be compared");
}

Image displayEncode(const Image& radiance, float stops) {
    Image encoded(radiance.width, radiance.height, radiance.components);
    const float scale = std::exp2(stops);
    const size_t rowValues = size_t{radiance.width} * radiance.components;
    tbb::parallel_for(size_t{0}, size_t{radiance.height}, [&](size_t y) {
        for (size_t i = y * rowValues; i < (y + 1) * rowValues; ++i) {
            const float value = radiance.pixels[i] * scale;
            encoded.pixels[i] = value > 0.0f ? std::min(srgbEncode(std::min(value, 1.0f)), 1.0f) : 0.0f;
        }
    });
    return encoded;
}

double mean(const Image& image) {
    return meanOverValues(image, [&](size_t i) { return static_cast<double>(image.pixels[i]); });
}

double psnr(const Image& test, const Image& reference) {
    checkComparable(test, reference);
    const double mse = meanOverValues(test, [&](size_t i) {
        const double d = static_cast<double>(test.pixels[i]) - static_cast<double>(reference.pixels[i]);
        return d * d;
    });
    return mse > 0.0 ? -10.0 * std::log10(mse) : std::numeric_limits<double>::infinity();
}

double relMse(const Image& test, const Image& reference) {
    checkComparable(test, reference);
    return meanOverValues(test, [&](size_t i) {
        const double x = test.pixels[i], r = reference.pixels[i];
        return (x - r) * (x - r) / (r * r + 0.01);
    });
}

Comparison compare(const Image& test, const Image& reference, float exposureStops) {
    checkComparable(test, reference);
    checkReferenceValid(reference);
    const std::vector<size_t> bad = invalidPixels(test);
    Image linear = test;
    for (const size_t pixel : bad) std::fill_n(&linear.pixels[3 * pixel], 3, largestHalf);
    Comparison result;
    result.shownReference = displayEncode(reference, exposureStops);
    result.shownTest = displayEncode(test, exposureStops);
    showAsWorst(bad, result.shownReference, result.shownTest);
    result.exposure = exposureStops;
    result.invalidPixels = bad.size();
    result.psnr = psnr(result.shownTest, result.shownReference);
    result.ssim = ssim(result.shownTest, result.shownReference);
    result.relMse = relMse(linear, reference);
    result.flipMap = flip(result.shownTest, result.shownReference);
    for (const size_t pixel : bad) result.flipMap.pixels[pixel] = 1.0f;
    result.flip = mean(result.flipMap);
    return result;
}

}  // namespace limpid::image
