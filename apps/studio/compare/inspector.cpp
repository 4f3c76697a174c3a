#include "studio/compare/inspector.h"

#include <algorithm>
#include <cmath>

#include "base/math.h"
#include "image/color.h"
#include "image/colormap.h"

namespace limpid::studio {
namespace {

constexpr uint32_t magenta = 0xFFFF00FFu;

uint32_t packed(const vec3& encoded) {
    const auto byte = [](float value) {
        return static_cast<uint32_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
    };
    return byte(encoded.r) | byte(encoded.g) << 8 | byte(encoded.b) << 16 | 0xFF000000u;
}

/// Returns the chosen channels of a pixel as red, green and blue.
vec3 chosen(const float* pixel, uint32_t components, int channels) {
    if (channels == InspectorView::Color)
        return components < 3 ? vec3(pixel[0]) : vec3(pixel[0], pixel[1], pixel[2]);
    return vec3(pixel[std::min(static_cast<uint32_t>(channels) - 1, components - 1)]);
}

}  // namespace

std::vector<uint32_t> shownTexels(const image::Image& picture, const InspectorView& view) {
    std::vector<uint32_t> texels;
    texels.reserve(size_t{picture.width} * picture.height);
    const float scale = std::exp2(view.stops);
    for (size_t at = 0; at < picture.pixels.size(); at += picture.components) {
        const vec3 value = scale * chosen(&picture.pixels[at], picture.components, view.channels);
        if (!std::isfinite(value.r) || !std::isfinite(value.g) || !std::isfinite(value.b)) {
            texels.push_back(magenta);
        } else if (view.falseColor) {
            const float luminance = image::luminance(value.r, value.g, value.b);
            const auto color = image::magma(std::clamp(luminance, 0.0f, 1.0f));
            texels.push_back(packed({color[0], color[1], color[2]}));
        } else {
            texels.push_back(
                packed({image::srgbEncode(value.r), image::srgbEncode(value.g), image::srgbEncode(value.b)}));
        }
    }
    return texels;
}

}  // namespace limpid::studio
