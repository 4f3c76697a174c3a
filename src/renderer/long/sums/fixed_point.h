// 128-bit fixed-point numbers, whose sums are exact: neither the order nor the grouping of the terms changes
// the result.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace limpid {

__extension__ typedef __int128 Int128;
__extension__ typedef unsigned __int128 Uint128;

/// The integer nearest to value * 2^fraction; halves are rounded away from zero. |value| < 2^(126 -
/// fraction).
inline Int128 toFixed(double value, int fraction) {
    constexpr uint64_t one = uint64_t{1} << 52;
    const uint64_t bits = std::bit_cast<uint64_t>(value);
    const int exponent = static_cast<int>((bits >> 52) & 2047u);
    if (exponent == 0) return 0;  // zero, or below 2^-1022
    const uint64_t mantissa = (bits & (one - 1)) | one;
    const int shift = exponent - 1075 + fraction;
    Uint128 magnitude = 0;
    if (shift >= 0) {
        magnitude = Uint128{mantissa} << shift;
    } else if (shift > -54) {
        magnitude = (mantissa + (uint64_t{1} << (-shift - 1))) >> -shift;
    }
    const auto result = static_cast<Int128>(magnitude);
    return bits >> 63 ? -result : result;
}

inline long double fromFixed(Int128 value, int fraction) {
    return std::ldexp(static_cast<long double>(value), -fraction);
}

/// Modulo 2^128: sums read from a file may have any value, and adding them must not be undefined behaviour.
inline Int128 addFixed(Int128 a, Int128 b) {
    return static_cast<Int128>(static_cast<Uint128>(a) + static_cast<Uint128>(b));
}

}  // namespace limpid
