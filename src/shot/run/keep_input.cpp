#include "shot/run/keep_input.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "shot/frame/pixel_layers.h"

namespace limpid::shot {
namespace {

constexpr std::array<float, 5> binomial{1.0f / 16, 4.0f / 16, 6.0f / 16, 4.0f / 16, 1.0f / 16};
constexpr float limitOfDifference = 4.0f;

/// Three values per pixel of a picture.
using Values = std::vector<float>;

/// Weighted means over 5 pixels along x (step 1) or y (step width), without those outside.
Values meansAlong(const Values& values, size_t width, bool alongX) {
    Values result(values.size());
    const size_t pixels = values.size() / 3, height = pixels / width;
    forEachPixel(pixels, [&](size_t p) {
        const auto at = static_cast<int64_t>(alongX ? p % width : p / width);
        const auto end = static_cast<int64_t>(alongX ? width : height);
        const int64_t step = alongX ? 1 : static_cast<int64_t>(width);
        float sums[3] = {}, weights = 0.0f;
        for (int64_t i = -2; i <= 2; ++i) {
            if (at + i < 0 || at + i >= end) continue;
            const float weight = binomial[static_cast<size_t>(i + 2)];
            const auto q = static_cast<size_t>(static_cast<int64_t>(p) + i * step);
            for (size_t c = 0; c < 3; ++c) sums[c] += weight * values[3 * q + c];
            weights += weight;
        }
        for (size_t c = 0; c < 3; ++c) result[3 * p + c] = sums[c] / weights;
    });
    return result;
}

Values means(const Values& values, size_t width) {
    return meansAlong(meansAlong(values, width, true), width, false);
}

}  // namespace

void mix(std::vector<float>& clean, const image::Image& noisy, float strength) {
    forEachPixel(clean.size() / 4, [&](size_t p) {
        for (size_t c = 0; c < 3; ++c) {
            const float input = noisy.pixels[3 * p + c];
            if (std::isfinite(input)) clean[4 * p + c] = input + strength * (clean[4 * p + c] - input);
        }
    });
}

void restoreDetail(std::vector<float>& clean, const image::Image& noisy, float preserve) {
    const size_t pixels = clean.size() / 4, width = noisy.width;
    Values differences(3 * pixels), sizes(3 * pixels);
    forEachPixel(3 * pixels, [&](size_t i) {
        const float difference = noisy.pixels[i] - clean[i / 3 * 4 + i % 3];
        differences[i] = std::isfinite(difference) ? difference : 0.0f;
        sizes[i] = std::abs(differences[i]);
    });
    const Values around = means(sizes, width);
    constexpr float own = binomial[2] * binomial[2];  // the pixel's weight in it (less at borders)
    forEachPixel(3 * pixels, [&](size_t i) {
        const float limit = limitOfDifference * std::max(around[i] - own * sizes[i], 0.0f) / (1.0f - own);
        differences[i] = std::clamp(differences[i], -limit, limit);
    });
    const Values detail = means(differences, width);
    forEachPixel(3 * pixels, [&](size_t i) {
        float& value = clean[i / 3 * 4 + i % 3];
        value = std::max(value + preserve * detail[i], 0.0f);
    });
}

}  // namespace limpid::shot
