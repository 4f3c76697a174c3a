// The points of src/shaders/common/sobol.glsl, computed from the definitions: Sobol's sequence from its
// direction numbers, Owen's scrambling bit by bit from the top.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "tests/reference/rng_copy.h"

namespace limpid::test {

inline uint32_t reversedBits(uint32_t x) {
    uint32_t result = 0;
    for (int bit = 0; bit < 32; ++bit) result |= (x >> bit & 1u) << (31 - bit);
    return result;
}

/// Direction numbers of dimension 0 or 1 (S. Joe, F. Y. Kuo 2008: polynomials 1 and x + 1, m_1 = 1), as
/// 32-bit fractions.
inline std::array<uint32_t, 32> directionNumbers(int dimension) {
    std::array<uint32_t, 32> v{};
    uint32_t m = 1;
    for (int k = 0; k < 32; ++k) {
        v[static_cast<std::size_t>(k)] = m << (31 - k);
        if (dimension == 1) m = m << 1 ^ m;
    }
    return v;
}

/// Returns Sobol's point as a 32-bit fraction.
inline uint32_t sobolPoint(uint32_t index, int dimension) {
    static const std::array<std::array<uint32_t, 32>, 2> directions{directionNumbers(0), directionNumbers(1)};
    uint32_t x = 0;
    for (std::size_t bit = 0; bit < 32; ++bit)
        if (index >> bit & 1u) x ^= directions[static_cast<std::size_t>(dimension)][bit];
    return x;
}

/// Vegdahl's permutation.
inline uint32_t permutedUpwards(uint32_t x, uint32_t key) {
    x ^= x * 0x3d20adeau;
    x += key;
    x *= key >> 16 | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/// Owen's scrambling of a fraction: each bit is flipped or not, depending on the higher ones.
inline uint32_t owenScrambled(uint32_t x, uint32_t key) {
    return reversedBits(permutedUpwards(reversedBits(x), key));
}

/// The same with a simpler permutation: one step of a linear congruential generator, and one round of Laine
/// and Karras's.
inline uint32_t lightlyScrambled(uint32_t x, uint32_t factor, uint32_t key) {
    uint32_t permuted = reversedBits(x) * factor + key;
    permuted ^= permuted * 0x05526c56u;
    return reversedBits(permuted);
}

class SobolCopy {
  public:
    SobolCopy(uint32_t x, uint32_t y, uint32_t number, uint32_t seed)
        : number_(number), x_(x), y_(y), key_(hash(seed)) {}

    float next() {
        const Draw draw = nextDraw();
        return toFloat(value(draw, 0));
    }
    std::array<float, 2> next2() {
        const Draw draw = nextDraw();
        return {toFloat(value(draw, 0)), toFloat(value(draw, 1))};
    }

  private:
    struct Draw {
        uint32_t number, pixel, key, factor;
    };

    static uint32_t hash(uint32_t x) {
        uint32_t state = x * 747796405u + 2891336453u;
        const uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
        return word >> 22 ^ word;
    }

    /// Returns the pixel's place in the order of pixels: two bits for each level of squares.
    uint32_t place(uint32_t split) const {
        uint32_t result = 0;
        for (int level = 15; level >= 0; --level) {
            const uint32_t x = x_ >> level & 1u, y = y_ >> level & 1u;
            const std::array<uint32_t, 2> digits = split == 0   ? std::array{y, x}
                                                   : split == 1 ? std::array{x, y}
                                                                : std::array{x ^ y, x};
            result = result << 2 | digits[0] << 1 | digits[1];
        }
        return result;
    }

    Draw nextDraw() {
        const uint32_t key = hash(key_ + draw_++);
        const uint32_t split = (key >> 16) * 3u >> 16;
        const uint32_t factor = hash(key ^ 0x68e31da4u) | 1u;
        return {owenScrambled(number_, key), lightlyScrambled(place(split), factor, key * 0x9e3779b1u), key,
                factor};
    }

    /// The pixel's index and its point have 16 digits.
    static uint32_t value(const Draw& draw, int dimension) {
        const std::array<uint32_t, 2> keys =
            dimension == 0 ? std::array{0x85ebca77u, 0xc2b2ae3du} : std::array{0x27d4eb2fu, 0x165667b1u};
        return owenScrambled(sobolPoint(draw.number, dimension), draw.key * keys[0]) ^
               (lightlyScrambled(sobolPoint(draw.pixel & 0xffffu, dimension), draw.factor,
                                 draw.key * keys[1]) &
                0xffff0000u);
    }

    static float toFloat(uint32_t x) { return static_cast<float>(x >> 8) / 16777216.0f; }

    uint32_t number_, x_, y_, key_, draw_ = 0;
};

}  // namespace limpid::test
