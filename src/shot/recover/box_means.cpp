#include "shot/recover/box_means.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace limpid::shot {
namespace {

using image::Image;

/// Running sums over lines of `length` values that lie `step` apart, for `count` neighbouring values at once.
void meansOfLines(const float* from, float* to, size_t count, size_t length, size_t step, size_t radius) {
    const auto value = [&](int64_t i, size_t k) {
        const int64_t last = static_cast<int64_t>(length) - 1;
        return from[static_cast<size_t>(std::clamp<int64_t>(i, 0, last)) * step + k];
    };
    const auto reach = static_cast<int64_t>(radius);
    std::vector<double> sums(count, 0.0);
    for (int64_t i = -reach; i < reach; ++i)
        for (size_t k = 0; k < count; ++k) sums[k] += value(i, k);
    const double scale = 1.0 / static_cast<double>(2 * radius + 1);
    for (int64_t i = 0; i < static_cast<int64_t>(length); ++i) {
        for (size_t k = 0; k < count; ++k) {
            sums[k] += value(i + reach, k);
            to[static_cast<size_t>(i) * step + k] = static_cast<float>(sums[k] * scale);
            sums[k] -= value(i - reach, k);
        }
    }
}

}  // namespace

Image boxMeans(const Image& picture, uint32_t radius) {
    Image rows(picture.width, picture.height, picture.components);
    Image result = rows;
    const size_t components = picture.components, rowLength = picture.width * components;
    using Range = tbb::blocked_range<size_t>;
    tbb::parallel_for(Range(0, picture.height), [&](const Range& range) {
        for (size_t y = range.begin(); y < range.end(); ++y)
            meansOfLines(&picture.pixels[y * rowLength], &rows.pixels[y * rowLength], components,
                         picture.width, components, radius);
    });
    // Strips, so that whole cache lines are used.
    constexpr size_t strip = 64;
    tbb::parallel_for(Range(0, (rowLength + strip - 1) / strip), [&](const Range& range) {
        for (size_t s = range.begin(); s < range.end(); ++s)
            meansOfLines(&rows.pixels[s * strip], &result.pixels[s * strip],
                         std::min(strip, rowLength - s * strip), picture.height, rowLength, radius);
    });
    return result;
}

}  // namespace limpid::shot
