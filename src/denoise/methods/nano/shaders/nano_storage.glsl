// What the buffers of `nano` hold: channels as halves, eight in a texel, those of a pixel side by side. Where filters
// read images, so are the weights: on CPUs, loads from an image take half of the time.
#ifndef LIMPID_NANO_STORAGE_GLSL
#define LIMPID_NANO_STORAGE_GLSL
#extension GL_EXT_control_flow_attributes : require

#include "denoise/methods/nano/nano_params.h"
#include "shaders/common/filter_image.glsl"

#define READ_TEXELS(slot, name) \
    layout(set = 0, binding = slot, scalar) readonly buffer name##Texels { uvec4 texels[]; } name
#define WRITE_TEXELS(slot, name) \
    layout(set = 0, binding = slot, scalar) writeonly buffer name##Texels { uvec4 texels[]; } name

#ifdef LIMPID_FILTER_BUFFERS
#define READ_WEIGHTS(slot, name) READ_TEXELS(slot, name)
#define LOAD_WEIGHTS(name, index) name.texels[index]
#else
#define READ_WEIGHTS(slot, name) layout(set = 0, binding = slot, rgba32ui) uniform readonly uimage2D name
#define LOAD_WEIGHTS(name, index) imageLoad(name, ivec2((index) % NANO_WEIGHTS_WIDTH, (index) / NANO_WEIGHTS_WIDTH))
#endif

struct Eight {
    vec4 low, high;
};

Eight unpackEight(uvec4 texel) {
    return Eight(unpackHalf4(texel.xy), unpackHalf4(texel.zw));
}

/// The value of this number, from 0 to 7.
float valueOf(Eight values, int number) {
    return number < 4 ? values.low[number] : values.high[number - 4];
}

/// Adds an input times the weights of eight outputs.
void addProduct(inout Eight sum, float x, Eight weights) {
    sum.low += x * weights.low;
    sum.high += x * weights.high;
}

uvec4 packEight(Eight values) {
    const vec4 least = vec4(-MAX_HALF), most = vec4(MAX_HALF);
    return uvec4(packHalf4(clamp(values.low, least, most)), packHalf4(clamp(values.high, least, most)));
}

/// The activation of every layer but the last ones.
vec4 leaky(vec4 x) {
    return max(x, 0.1 * x);
}

/// Light of both signals, as a texel holds it, and whether a surface is seen: other light is not filtered.
struct LightPair {
    vec3 diffuse, specular;
    bool seen;
};

LightPair lightPairOf(uvec4 texel) {
    const Eight values = unpackEight(texel);
    return LightPair(values.low.rgb, vec3(values.low.a, values.high.rg), values.high.b > 0.0);
}

uvec4 packLightPair(LightPair light) {
    const float seen = light.seen ? 1.0 : 0.0;
    return packEight(Eight(vec4(light.diffuse, light.specular.r), vec4(light.specular.gb, seen, 0.0)));
}

/// Weighted light of both signals, and the weights.
struct LightSums {
    vec4 diffuse, specular;
};

void add(inout LightSums sums, LightPair light, vec2 weights) {
    if (!light.seen) return;
    sums.diffuse += weights.x * vec4(light.diffuse, 1.0);
    sums.specular += weights.y * vec4(light.specular, 1.0);
}

LightPair meanOf(LightSums sums) {
    const bool seen = sums.diffuse.a > 0.0;
    return LightPair(seen ? sums.diffuse.rgb / sums.diffuse.a : vec3(0.0),
                     seen ? sums.specular.rgb / sums.specular.a : vec3(0.0), seen);
}

#endif
