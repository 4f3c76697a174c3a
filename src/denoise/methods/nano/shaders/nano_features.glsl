// What the network sees of a pixel, its first layer, and the light that is filtered. Pixels beyond the picture's edges
// repeat those at the edges. docs/nano.md has the list.
#include "denoise/methods/nano/shaders/nano_storage.glsl"
#include "denoise/methods/svgf/shaders/svgf_stable.glsl"
#include "denoise/stages/guides.glsl"
#include "denoise/stages/surfaces/surface_texel.glsl"
#include "shaders/common/sampling.glsl"

#ifdef LIMPID_FILTER_BUFFERS
const int PIXELS = 1;  // in a row, that an invocation computes
#else
const int PIXELS = NANO_IMAGE_PIXELS;
#endif

layout(constant_id = 0) const bool TWO_SIGNALS = true;   // else the second is black
layout(constant_id = 1) const bool HAS_PAST = true;      // else the filtered light stands for that of the past
layout(constant_id = 2) const uint OUTPUT_GROUPS = 2u;   // of the first layer

layout(set = 0, binding = 0, scalar) uniform Params {
    NanoFeaturesParams params;
};
READ_UINT2(1, surfaces);
READ_HALF4(2, colorA);  // accumulated light and its deviation
READ_HALF4(3, colorB);
READ_HALF4(4, firstA);  // after the first level
READ_HALF4(5, firstB);
READ_HALF4(6, filteredA);
READ_HALF4(7, filteredB);
READ_UINT1(8, pastA);  // svgf_stable.glsl
READ_UINT1(9, pastB);
layout(set = 0, binding = 10, rgba16f) uniform readonly image2D momentsA;
layout(set = 0, binding = 11, rgba16f) uniform readonly image2D momentsB;
READ_LAYER(12, albedoA);
READ_LAYER(13, albedoB);
READ_WEIGHTS(14, weights);  // of the first layer
WRITE_TEXELS(15, channels);
WRITE_TEXELS(16, light);

/// Of one signal.
struct Signal {
    vec3 color;
    float accumulated, first, filtered, past, deviation, frames;
};

float seen(vec3 light) {
    return luminance(max(light, vec3(0.0)));
}

Signal signalOf(vec4 color, vec4 first, vec4 filtered, vec3 before, float frames) {
    return Signal(max(color.rgb, vec3(0.0)), seen(color.rgb), seen(first.rgb), seen(filtered.rgb), seen(before),
                  max(color.a, 0.0), frames);
}

ivec2 inside(ivec2 at) {
    return clamp(at, ivec2(0), ivec2(params.width, params.height) - 1);
}

vec2 logarithm(float a, float b) {
    return 0.2 * log2(vec2(a, b) + 0.01);
}

float logDistance(ivec2 at) {
    return log2(distanceOf(LOAD_UINT2(surfaces, inside(at))) + 0.01);
}

/// Four times the difference of the logarithm of the distance and the mean of its four neighbours': edges and curved
/// surfaces.
float bend(ivec2 at, float own) {
    const float around = logDistance(at + ivec2(-1, 0)) + logDistance(at + ivec2(1, 0)) +
                         logDistance(at + ivec2(0, -1)) + logDistance(at + ivec2(0, 1));
    return clamp(4.0 * own - around, -1.0, 1.0);
}

/// The component along an axis, which may be 0.
float along(vec3 axis, vec3 normal) {
    return dot(normal, axis) * inversesqrt(max(dot(axis, axis), 1e-30));
}

/// Components to the right, up, and towards the camera.
vec3 inView(vec3 normal) {
    return vec3(along(params.camera.right, normal), along(params.camera.up, normal),
                -dot(normal, params.camera.forward));
}

struct Features {
    float values[NANO_FEATURES];
};

/// Limited to what real albedos are.
vec3 albedoOf(vec4 texel) {
    return clamp(finiteOr(texel.rgb, vec3(1.0)), 0.0, 1.0);
}

Features gather(ivec2 at, Signal a, Signal b) {
    Features features;
    const uvec2 surface = LOAD_UINT2(surfaces, at);
    const bool sees = distanceOf(surface) > 0.0;
    const float distance = logDistance(at);
    // Frames may say anything of the surface where there is none. The network knows 0 there.
    const vec3 albedo = sees ? albedoOf(LOAD_WIDE_LAYER(albedoA, at)) : vec3(0.0);
    const vec3 mirror = sees && TWO_SIGNALS ? albedoOf(LOAD_WIDE_LAYER(albedoB, at)) : vec3(0.0);
    const vec3 normal = sees ? inView(normalOf(surface)) : vec3(0.0);
    const float roughness = sees ? roughnessOf(surface) : 0.0;
    const vec2 tone = vec2(a.filtered, b.filtered) + 0.02;
    const vec2 pairs[7] = vec2[7](logarithm(a.accumulated, b.accumulated), logarithm(a.filtered, b.filtered),
                                  logarithm(a.first, b.first), logarithm(a.past, b.past),
                                  clamp(vec2(a.accumulated - a.filtered, b.accumulated - b.filtered) / tone, -2.0, 2.0),
                                  0.5 * min(vec2(a.deviation, b.deviation) / tone, 4.0),
                                  1.0 / max(vec2(a.frames, b.frames), 1.0));
    [[unroll]] for (int i = 0; i < 7; ++i) {
        features.values[2 * i] = pairs[i].x;
        features.values[2 * i + 1] = pairs[i].y;
    }
    const vec4 rest[3] = vec4[3](vec4(albedo, min(luminance(mirror), 1.0)),
                                 vec4(normal, 0.25 * distance),
                                 vec4(4.0 * bend(at, distance), roughness, 0.0, 0.0));
    [[unroll]] for (int i = 0; i < 10; ++i) features.values[14 + i] = rest[i / 4][i % 4];
    return features;
}

/// Stores the pixel's light, too.
Features featuresOf(ivec2 pixel, uint index) {
    const ivec2 at = inside(pixel + ivec2(params.tileX, params.tileY));
    const vec4 filtered = LOAD_HALF4(filteredA, at);
    vec3 before = filtered.rgb;
    if (HAS_PAST) before = unpackedStable(LOAD_UINT1(pastA, at));
    const Signal a =
        signalOf(LOAD_HALF4(colorA, at), LOAD_HALF4(firstA, at), filtered, before, imageLoad(momentsA, at).w);
    Signal b = Signal(vec3(0.0), 0.0, 0.0, 0.0, 0.0, 0.0, a.frames);
    if (TWO_SIGNALS) {
        const vec4 filteredToo = LOAD_HALF4(filteredB, at);
        before = filteredToo.rgb;
        if (HAS_PAST) before = unpackedStable(LOAD_UINT1(pastB, at));
        b = signalOf(LOAD_HALF4(colorB, at), LOAD_HALF4(firstB, at), filteredToo, before, imageLoad(momentsB, at).w);
    }
    const bool sees = distanceOf(LOAD_UINT2(surfaces, at)) > 0.0;
    light.texels[index] = packLightPair(LightPair(a.color, b.color, sees));
    return gather(at, a, b);
}

void main() {
    const ivec2 first = ivec2(gl_GlobalInvocationID.xy) * ivec2(PIXELS, 1);
    if (first.x >= int(params.paddedWidth) || first.y >= int(params.paddedHeight)) return;
    const uint index = uint(first.y) * params.paddedWidth + uint(first.x);  // padded to whole invocations
    Features features[PIXELS];
    [[unroll]] for (int p = 0; p < PIXELS; ++p) features[p] = featuresOf(first + ivec2(p, 0), index + uint(p));
    [[unroll]] for (uint group = 0u; group < OUTPUT_GROUPS; ++group) {
        const Eight bias = unpackEight(LOAD_WEIGHTS(weights, group));
        Eight sums[PIXELS];
        [[unroll]] for (int p = 0; p < PIXELS; ++p) sums[p] = bias;
        [[unroll]] for (uint i = 0u; i < NANO_FEATURES; ++i) {
            const uint at = OUTPUT_GROUPS + ((i / 8u) * OUTPUT_GROUPS + group) * 8u + i % 8u;
            const Eight w = unpackEight(LOAD_WEIGHTS(weights, at));
            [[unroll]] for (int p = 0; p < PIXELS; ++p) addProduct(sums[p], features[p].values[i], w);
        }
        [[unroll]] for (int p = 0; p < PIXELS; ++p)
            channels.texels[(index + uint(p)) * OUTPUT_GROUPS + group] =
                packEight(Eight(leaky(sums[p].low), leaky(sums[p].high)));
    }
}
