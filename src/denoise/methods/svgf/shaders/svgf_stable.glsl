// How stabilised light is stored: a word for three components of either sign, which share an exponent. As a history it
// has at most half of the weight in the next frame's light, so steps of 1/256 of the largest component are enough.
#ifndef LIMPID_SVGF_STABLE_GLSL
#define LIMPID_SVGF_STABLE_GLSL

const int STABLE_EXPONENT = 23;  // components are whole numbers from -256 to 255, times 2^(exponent - this)

/// Rounds to nearest. `light` is at most MAX_HALF in magnitude, which becomes 65280.
uint packedStable(vec3 light) {
    const float largest = max(max(abs(light.r), abs(light.g)), abs(light.b));
    // The largest component becomes 128 to 255: a little more would be rounded to 256.
    const int exponent = int(floatBitsToUint(largest * (256.0 / 255.5)) >> 23) - 127 - 7 + STABLE_EXPONENT;
    const int kept = clamp(exponent, 0, 31);
    const float scale = uintBitsToFloat(uint(127 + STABLE_EXPONENT - kept) << 23);
    const ivec3 whole = clamp(ivec3(round(light * scale)), ivec3(-256), ivec3(255)) & 0x1FF;
    return uint(whole.r) | uint(whole.g) << 9 | uint(whole.b) << 18 | uint(kept) << 27;
}

vec3 unpackedStable(uint texel) {
    const int bits = int(texel);
    const ivec3 whole = ivec3(bitfieldExtract(bits, 0, 9), bitfieldExtract(bits, 9, 9), bitfieldExtract(bits, 18, 9));
    return vec3(whole) * uintBitsToFloat((texel >> 27) + uint(127 - STABLE_EXPONENT) << 23);
}

#endif
