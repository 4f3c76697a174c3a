// What a texel of the `surfaces` image holds: normal and roughness in the first word, the distance in the second.
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

/// From the eye along the ray; 0: nothing is seen.
float distanceOf(uvec2 surface) {
    return uintBitsToFloat(surface.y);
}

#endif
