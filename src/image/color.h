// The sRGB transfer functions (IEC 61966-2-1, exact piecewise form) and Rec. 709 luminance.
#pragma once

#include <cmath>

namespace limpid::image {

/// Converts linear [0,1] to sRGB-encoded [0,1]. Odd extension below 0; no clamp above 1.
inline float srgbEncode(float linear) {
    if (linear < 0.0f) return -srgbEncode(-linear);
    if (linear <= 0.0031308f) return 12.92f * linear;
    // Computed in double, so that 1 maps to exactly 1.
    return static_cast<float>(1.055 * static_cast<double>(std::pow(linear, 1.0f / 2.4f)) - 0.055);
}

/// Converts sRGB-encoded [0,1] to linear [0,1]; the inverse of srgbEncode.
inline float srgbDecode(float encoded) {
    if (encoded < 0.0f) return -srgbDecode(-encoded);
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// Relative luminance of linear Rec. 709 radiance; for encoded values it is Rec. 709 luma.
inline float luminance(float r, float g, float b) {
    return 0.2126f * r + 0.7152f * g + 0.0722f * b;
}

}  // namespace limpid::image
