#include "image/tonemap.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "image/color.h"

namespace limpid::image {
namespace {

float pixelLuminance(const Image& image, size_t pixel) {
    const float* p = &image.pixels[pixel * image.components];
    return image.components < 3 ? p[0] : luminance(p[0], p[1], p[2]);
}

bool usable(float value) {
    return std::isfinite(value) && value > 0.0f;
}

}  // namespace

double filmicCurveInverse(double display) {
    // y = x (A x + B) / (x (C x + D) + E) is equivalent to a x^2 + b x + c = 0; c <= 0 <= a, so one root is
    // not negative.
    const double a = double{filmicA} - display * double{filmicC};
    const double b = double{filmicB} - display * double{filmicD};
    const double c = -display * double{filmicE};
    return (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a) / double{filmicScale};
}

float autoExposure(const Image& radiance, std::span<const float> subject) {
    return measuredExposure(radiance, subject).value_or(0.0f);
}

std::optional<float> measuredExposure(const Image& radiance, std::span<const float> subject) {
    const auto isSubject = [](float share) { return share >= 0.5f; };
    if (std::none_of(subject.begin(), subject.end(), isSubject)) subject = {};
    const size_t count = size_t{radiance.width} * radiance.height;
    double sum = 0.0;
    size_t counted = 0;
    for (size_t i = 0; i < count; ++i) {
        if (!subject.empty() && !isSubject(subject[i])) continue;
        const float value = pixelLuminance(radiance, i);
        if (usable(value)) sum += value;
        ++counted;
    }
    const double threshold = 1e-5 * sum / std::max<double>(1.0, static_cast<double>(counted));
    double logSum = 0.0;
    size_t used = 0;
    for (size_t i = 0; i < count; ++i) {
        if (!subject.empty() && !isSubject(subject[i])) continue;
        const float value = pixelLuminance(radiance, i);
        if (!usable(value) || value < threshold) continue;
        logSum += std::log2(static_cast<double>(value));
        ++used;
    }
    if (used == 0) return std::nullopt;
    const double stops = std::log2(static_cast<double>(filmicKey)) - logSum / static_cast<double>(used);
    return static_cast<float>(std::clamp(stops, -40.0, 40.0));
}

float sequenceExposure(std::span<const std::optional<float>> frames) {
    double sum = 0.0;
    size_t used = 0;
    for (const std::optional<float>& stops : frames) {
        sum += stops.value_or(0.0f);
        used += stops ? 1 : 0;
    }
    return used > 0 ? static_cast<float>(sum / static_cast<double>(used)) : 0.0f;
}

Image tonemap(const Image& radiance, float stops, ToneCurve curve) {
    Image encoded(radiance.width, radiance.height, radiance.components);
    const float scale = std::exp2(stops);
    const size_t components = radiance.components, count = size_t{radiance.width} * radiance.height;
    tbb::parallel_for(tbb::blocked_range<size_t>(0, count, 1 << 12), [&](const auto& range) {
        for (size_t i = range.begin(); i != range.end(); ++i) {
            const float* const from = &radiance.pixels[i * components];
            float* const to = &encoded.pixels[i * components];
            const bool grey = components < 3;
            const vec3 shown =
                displayColor(curve, scale * (grey ? vec3(from[0]) : vec3(from[0], from[1], from[2])));
            for (size_t c = 0; c < components; ++c)
                to[c] = c < 3 ? shown[static_cast<int>(c)] : std::clamp(from[c], 0.0f, 1.0f);
        }
    });
    return encoded;
}

}  // namespace limpid::image
