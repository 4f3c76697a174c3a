// What a texel of the `surfaces` image holds: normal and roughness in the first word, distance and instance in the second.
#ifndef LIMPID_SURFACE_TEXEL_GLSL
#define LIMPID_SURFACE_TEXEL_GLSL

#include "shaders/common/sampling.glsl"

/// Octahedral coordinates of 12 bits each (an error of at most 0.06 degrees) and the roughness in 8 bits. `normal` is a
/// unit vector or 0, which becomes +Z. A negative roughness, or NaN, counts as 1.
uint packedShading(vec3 normal, float roughness) {
    const ivec2 e = ivec2(round(clamp(octahedralOf(normal), -1.0, 1.0) * 2047.0));
    const uint r = uint((roughness >= 0.0 ? min(roughness, 1.0) : 1.0) * 255.0 + 0.5);
    return (uint(e.x) & 0xFFFu) | (uint(e.y) & 0xFFFu) << 12 | r << 24;
}

vec3 normalOf(uvec2 surface) {
    return fromOctahedral(vec2(signedOf(surface.x & 0xFFFu, 12u), signedOf((surface.x >> 12) & 0xFFFu, 12u)), 2047.0);
}

/// In units of 1 / 255, plus 256: the bits become a float's mantissa, because GPUs convert integers at an eighth of
/// their addition rate.
float roughnessStepsOf(uvec2 surface) {
    return uintBitsToFloat(0x43800000u | (surface.x >> 24) << 15);
}

float roughnessOf(uvec2 surface) {
    return (roughnessStepsOf(surface) - 256.0) / 255.0;
}

const uint INSTANCE_MASK = 0x1FFFu;  // the lower 13 bits; above them 6 of the distance's exponent and 13 of its mantissa
const float DISTANCE_UNIT = 39614081257132168796771975168.0;  // 2^95: makes an exponent of 6 bits one of 8
const float MIN_DISTANCE = 4.6566128730773926e-10, MAX_DISTANCE = 4e9;  // 2^-31, and nearly 2^32

/// A number from 1 to 8191 for an object. Numbers below 8191 stay different from one another. Others may meet, and then
/// only normals and distances tell two objects apart.
uint instanceNumber(uint id) {
    const uint number = id + 1u;
    return max((number ^ number >> 13 ^ number >> 26) & INSTANCE_MASK, 1u);
}

/// `distance` is rounded to nearest: it is wrong by at most 2^-14 of itself. 0: nothing is seen.
uint packedPlace(float distance, uint id) {
    if (!(distance > 0.0)) return 0u;
    const uint bits = floatBitsToUint(clamp(distance, MIN_DISTANCE, MAX_DISTANCE) / DISTANCE_UNIT) + 0x200u;
    return (bits << 3 & ~INSTANCE_MASK) | instanceNumber(id);
}

/// From the eye along the ray; 0: nothing is seen.
float distanceOf(uvec2 surface) {
    return uintBitsToFloat((surface.y & ~INSTANCE_MASK) >> 3) * DISTANCE_UNIT;
}

/// 0: nothing is seen.
uint instanceOf(uvec2 surface) {
    return surface.y & INSTANCE_MASK;
}

#endif
