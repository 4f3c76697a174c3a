// A fast exponential function.
#pragma once

#include <bit>

namespace limpid::neural {

/// The smallest x that exponential() takes.
inline constexpr float leastExponent = -87.0f;

/// Returns e^x with a relative error below 3e-7 for x from -87 to 0. Compilers can vectorise it, if x is
/// limited to that range in a loop before: together with a comparison they cannot. x is split into a power of
/// 2, which becomes the float's exponent, and a remainder, for which a Taylor polynomial is used.
inline float exponential(float x) {
    const float t = x * 1.44269504f;
    const float whole = static_cast<float>(static_cast<int>(t - 0.5f));
    const float f = (t - whole) * 0.693147181f;
    float p = 1.0f / 720.0f;
    p = p * f + 1.0f / 120.0f;
    p = p * f + 1.0f / 24.0f;
    p = p * f + 1.0f / 6.0f;
    p = p * f + 0.5f;
    p = p * f + 1.0f;
    p = p * f + 1.0f;
    return p * std::bit_cast<float>((static_cast<int>(whole) + 127) << 23);
}

}  // namespace limpid::neural
