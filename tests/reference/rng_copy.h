// A C++ copy of the shaders' random numbers (src/shaders/common/rng.glsl).
#pragma once

#include <cstdint>

namespace limpid::test {

inline uint32_t tea(uint32_t v0, uint32_t v1) {
    uint32_t sum = 0;
    for (int round = 0; round < 16; ++round) {
        sum += 0x9e3779b9u;
        v0 += ((v1 << 4) + 0xa341316cu) ^ (v1 + sum) ^ ((v1 >> 5) + 0xc8013ea4u);
        v1 += ((v0 << 4) + 0xad90777du) ^ (v0 + sum) ^ ((v0 >> 5) + 0x7e95761eu);
    }
    return v0;
}

inline uint32_t startStream(uint32_t pixel, uint32_t frame, uint32_t seed) {
    return tea(pixel, frame ^ seed * 0x9e3779b9u);
}

/// Numerical Recipes' generator, low 24 bits.
inline float lcg(uint32_t& state) {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state & 0xffffffu) / 16777216.0f;
}

/// PCG-RXS-M-XS-32, high 24 bits. The output belongs to the state before the step.
inline float pcg(uint32_t& state) {
    const uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737u;
    state = state * 747796405u + 2891336453u;
    return static_cast<float>(((word >> 22) ^ word) >> 8) / 16777216.0f;
}

}  // namespace limpid::test
