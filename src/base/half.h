// Half-precision numbers (IEEE 754 binary16) on the CPU.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

namespace limpid {

inline float halfToFloat(uint16_t half) {
    const uint32_t sign = (half & 0x8000u) << 16;
    const uint32_t exponent = half >> 10 & 31u, fraction = half & 0x3FFu;
    if (exponent == 31) return std::bit_cast<float>(sign | 0x7F800000u | fraction << 13);
    if (exponent != 0) return std::bit_cast<float>(sign | (exponent + 112) << 23 | fraction << 13);
    const float subnormal = static_cast<float>(fraction) * 0x1p-24f;
    return sign ? -subnormal : subnormal;
}

/// The same for as many halves as there are in both; they must be finite. Compilers can vectorise it.
inline void toFloats(std::span<const uint16_t> halves, std::span<float> floats) {
    const size_t count = std::min(halves.size(), floats.size());
    for (size_t i = 0; i < count; ++i) {
        const uint32_t half = halves[i];
        const float size = std::bit_cast<float>((half & 0x7FFFu) << 13) * 0x1p112f;
        floats[i] = std::bit_cast<float>(std::bit_cast<uint32_t>(size) | (half & 0x8000u) << 16);
    }
}

}  // namespace limpid
