// How the levels store a pixel, in one word: 16 bits of visibility, and 16 of its expected deviation or a mark. Fixed
// point, since lavapipe computes halves of words bit by bit. The bits become a float's mantissa, because GPUs convert
// integers at an eighth of their addition rate.
#ifndef LIMPID_VISIBILITY_TEXEL_GLSL
#define LIMPID_VISIBILITY_TEXEL_GLSL

// Marks in place of a deviation.
const float NOTHING_SEEN = -2.0 / 65536.0;
const float UNKNOWN = -1.0 / 65536.0;  // a surface without history, whose sample was rejected

/// Of 16 bits, as a share of 65536. Exact.
float shareOf(uint bits) {
    return uintBitsToFloat(0x3f800000u | bits << 7) - 1.0;
}

/// Visibility and deviation. A deviation of 0 or more is exactly that.
vec2 unpackedSignal(uint word) {
    return vec2(shareOf(word & 0xffffu) * (65536.0 / 65535.0), shareOf(word >> 16) + NOTHING_SEEN);
}

uint packedSignal(vec2 signal) {
    const uint visibility = uint(clamp(signal.x, 0.0, 1.0) * 65535.0 + 0.5);
    const uint deviation = uint(clamp((signal.y - NOTHING_SEEN) * 65536.0 + 0.5, 0.0, 65535.0));
    return visibility | deviation << 16;
}

#endif
