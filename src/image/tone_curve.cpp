#include "image/tone_curve.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "image/color.h"
#include "image/filmic.h"

namespace limpid::image {
namespace {

/// Without NaN and negative values.
vec3 usableOf(const vec3& exposed) {
    vec3 usable;
    for (int i = 0; i < 3; ++i) usable[i] = exposed[i] > 0.0f ? exposed[i] : 0.0f;
    return usable;
}

vec3 encoded(const vec3& linear) {
    return {srgbEncode(linear.r), srgbEncode(linear.g), srgbEncode(linear.b)};
}

float agxContrast(float x) {
    float y = 0.0f;
    for (const float factor : {LIMPID_AGX_CONTRAST}) y = y * x + factor;
    return y;
}

vec3 agx(const vec3& exposed) {
    const mat3 inset(LIMPID_AGX_INSET), outset(LIMPID_AGX_OUTSET);
    vec3 value = inset * glm::min(exposed, vec3(filmicLargest));
    for (int i = 0; i < 3; ++i) {
        // The logarithm of 0 is clamped as well.
        const float stops = std::clamp(std::log2(value[i]), agxMinStops, agxMaxStops);
        value[i] = agxContrast((stops - agxMinStops) / (agxMaxStops - agxMinStops));
    }
    return glm::clamp(outset * value, vec3(0.0f), vec3(1.0f));
}

const vec3& falseColor(const vec3& exposed) {
    const float brightness = luminance(exposed.r, exposed.g, exposed.b);
    const auto most = static_cast<float>(falseColorStops);
    const float stops = std::clamp(std::log2(brightness / filmicKey), -most, most);
    return falseColors()[static_cast<size_t>(std::lround(stops) + falseColorStops)];
}

}  // namespace

const std::vector<std::string>& toneCurveNames() {
    static const std::vector<std::string> names{"standard", "agx", "none", "false-color"};
    return names;
}

std::string_view nameOf(ToneCurve curve) {
    return toneCurveNames()[static_cast<size_t>(curve)];
}

ToneCurve parseToneCurve(std::string_view name) {
    const std::vector<std::string>& names = toneCurveNames();
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
        throw UsageError("there is no tone curve '" + std::string(name) +
                         "'; there are standard, agx, none and false-color");
    return static_cast<ToneCurve>(found - names.begin());
}

vec3 displayColor(ToneCurve curve, const vec3& exposed) {
    const vec3 usable = usableOf(exposed);
    switch (curve) {
        case ToneCurve::Standard:
            return encoded({filmicCurve(usable.r), filmicCurve(usable.g), filmicCurve(usable.b)});
        case ToneCurve::Agx:
            return agx(usable);
        case ToneCurve::None:
            return encoded(glm::min(usable, vec3(1.0f)));
        case ToneCurve::FalseColor:
            return falseColor(glm::min(usable, vec3(filmicLargest)));
    }
    return vec3(0.0f);
}

vec3 extendedColor(const vec3& exposed) {
    return encoded(glm::min(usableOf(exposed), vec3(extendedLargest)));
}

std::span<const vec3> falseColors() {
    static const vec3 colors[] = {LIMPID_FALSE_COLORS};
    static_assert(std::size(colors) == 2 * falseColorStops + 1);
    return colors;
}

}  // namespace limpid::image
