// Images that a filter reads many times: storage images, or texels in buffers (gpu::Backing) if the including
// shader defines LIMPID_FILTER_BUFFERS. Declare them with READ_*, WRITE_* and UPDATE_* (both), access them
// with LOAD_* and STORE_*. The including shader's `params` must have the picture's `width`. HALF4: four
// halves. UINT1, UINT2: one and two words.
#ifndef LIMPID_FILTER_IMAGE_GLSL
#define LIMPID_FILTER_IMAGE_GLSL

const float MAX_HALF = 65504.0;

/// Rounds to the nearest half, ties to even, for magnitudes up to MAX_HALF. Drivers round towards zero in
/// packHalf2x16 and in stores, which would darken the picture with every level of a filter.
vec4 nearestHalf(vec4 value) {
    const uvec4 bits = floatBitsToUint(value);
    const vec4 normal = uintBitsToFloat((bits + 0xFFFu + (bits >> 13 & 1u)) & ~0x1FFFu);
    // Halves below 2^-14 are multiples of 2^-24.
    const vec4 subnormal = roundEven(value * 16777216.0) / 16777216.0;
    return mix(normal, subnormal, lessThan(abs(value), vec4(1.0 / 16384.0)));
}

vec4 unpackHalf4(uvec2 texel) {
    return vec4(unpackHalf2x16(texel.x), unpackHalf2x16(texel.y));
}

uvec2 packHalf4(vec4 value) {
    const vec4 nearest = nearestHalf(value);
    return uvec2(packHalf2x16(nearest.xy), packHalf2x16(nearest.zw));
}

#ifdef LIMPID_FILTER_BUFFERS

#define TEXEL_INDEX(at) (uint((at).y) * params.width + uint((at).x))
#define READ_UINT2(slot, name) \
    layout(set = 0, binding = slot, scalar) readonly buffer name##Texels { uvec2 texels[]; } name
#define WRITE_UINT2(slot, name) \
    layout(set = 0, binding = slot, scalar) writeonly buffer name##Texels { uvec2 texels[]; } name
#define UPDATE_UINT2(slot, name) \
    layout(set = 0, binding = slot, scalar) buffer name##Texels { uvec2 texels[]; } name
#define LOAD_UINT2(name, at) name.texels[TEXEL_INDEX(at)]
#define STORE_UINT2(name, at, value) name.texels[TEXEL_INDEX(at)] = value
#define READ_HALF4(slot, name) READ_UINT2(slot, name)
#define WRITE_HALF4(slot, name) WRITE_UINT2(slot, name)
#define UPDATE_HALF4(slot, name) UPDATE_UINT2(slot, name)
#define LOAD_HALF4(name, at) unpackHalf4(LOAD_UINT2(name, at))
#define LOAD_HALF4_ALPHA(name, at) unpackHalf2x16(LOAD_UINT2(name, at).y).y
#define STORE_HALF4(name, at, value) STORE_UINT2(name, at, packHalf4(value))
#define READ_UINT1(slot, name) \
    layout(set = 0, binding = slot, scalar) readonly buffer name##Texels { uint texels[]; } name
#define WRITE_UINT1(slot, name) \
    layout(set = 0, binding = slot, scalar) writeonly buffer name##Texels { uint texels[]; } name
#define UPDATE_UINT1(slot, name) \
    layout(set = 0, binding = slot, scalar) buffer name##Texels { uint texels[]; } name
#define LOAD_UINT1(name, at) name.texels[TEXEL_INDEX(at)]
#define STORE_UINT1(name, at, value) name.texels[TEXEL_INDEX(at)] = value

#else

#define READ_UINT2(slot, name) layout(set = 0, binding = slot, rg32ui) uniform readonly uimage2D name
#define WRITE_UINT2(slot, name) layout(set = 0, binding = slot, rg32ui) uniform writeonly uimage2D name
#define LOAD_UINT2(name, at) imageLoad(name, at).xy
#define STORE_UINT2(name, at, value) imageStore(name, at, uvec4(value, 0u, 0u))
#define READ_HALF4(slot, name) layout(set = 0, binding = slot, rgba16f) uniform readonly image2D name
#define WRITE_HALF4(slot, name) layout(set = 0, binding = slot, rgba16f) uniform writeonly image2D name
#define UPDATE_HALF4(slot, name) layout(set = 0, binding = slot, rgba16f) uniform image2D name
#define LOAD_HALF4(name, at) imageLoad(name, at)
#define LOAD_HALF4_ALPHA(name, at) imageLoad(name, at).a
#define STORE_HALF4(name, at, value) imageStore(name, at, nearestHalf(value))
#define READ_UINT1(slot, name) layout(set = 0, binding = slot, r32ui) uniform readonly uimage2D name
#define WRITE_UINT1(slot, name) layout(set = 0, binding = slot, r32ui) uniform writeonly uimage2D name
#define UPDATE_UINT1(slot, name) layout(set = 0, binding = slot, r32ui) uniform uimage2D name
#define LOAD_UINT1(name, at) imageLoad(name, at).x
#define STORE_UINT1(name, at, value) imageStore(name, at, uvec4(value, 0u, 0u, 0u))

#endif
#endif
