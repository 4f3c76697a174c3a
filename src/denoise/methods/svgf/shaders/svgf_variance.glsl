// Estimates the deviation of pixels with a short history from the moments of their neighbours, and dims fireflies
// among them. docs/denoising.md, SVGF, step 5.
#include "denoise/methods/svgf/shaders/svgf_moments.glsl"
#include "denoise/methods/svgf/svgf_params.h"
#include "shaders/common/filter_image.glsl"

layout(set = 0, binding = 0, scalar) uniform Params {
    SvgfFilterParams params;
};
READ_UINT2(1, surfaces);
layout(set = 0, binding = 2, rgba16f) uniform readonly image2D moments;
UPDATE_HALF4(3, color);

#include "denoise/methods/svgf/shaders/svgf_weights.glsl"

layout(constant_id = 3) const bool BOOST = true;
layout(constant_id = 4) const bool FIREFLIES = true;

const int RADIUS = 3;

bool isYoung(ivec2 at) {
    return at.x < int(params.width) && at.y < int(params.height) && LOAD_HALF4_ALPHA(color, at) == SVGF_STILL_YOUNG;
}

/// The sums of weight, luminance, squared luminance and squared weight over the 8 neighbours. Their means are read from
/// the moments, since other invocations dim `color` at the same time.
vec4 luminancesAround(ivec2 at) {
    const SurfaceCentre centre = centreOf(surfaceAt(at), at);
    vec4 sums = vec4(0.0);
    for (int i = 0; i < 9; ++i) {
        const ivec2 from = ivec2(i % 3, i / 3) - 1, there = at + from;
        const ivec2 inside = clamp(there, ivec2(0), ivec2(params.width, params.height) - 1);
        const vec2 m = imageLoad(moments, inside).xw;
        const float exponent = surfaceExponent(centre, surfaceAt(inside), perDepthOf(centre, from));
        if (i == 4 || inside != there || m.y <= 0.0) continue;
        const float weight = exp2(exponent);
        sums += weight * vec4(1.0, m.x, m.x * m.x, weight);
    }
    return sums;
}

/// Whether the neighbours tell what light is usual here: not if they show other surfaces, nor if all but one do. One
/// value has no deviation. By it, lone bright hairs would become as dark as the one hair beside them.
bool tellUsual(vec4 sums) {
    return sums.x >= SVGF_MIN_WEIGHTS && sums.x * sums.x >= SVGF_MIN_ALIKE * sums.w;
}

/// `light` and its deviation. The longer the history, the less one sample can do.
vec4 withoutFirefly(ivec2 at, vec4 light, float frames) {
    const vec4 sums = luminancesAround(at);
    const float l = luminance(light.rgb);
    if (!tellUsual(sums)) return light;
    const vec2 mean = sums.yz / sums.x;
    const float deviation = sqrt(max(mean.y - mean.x * mean.x, 0.0));
    const float usual = mean.x + params.fireflies * frames * frames * deviation + SVGF_LUMINANCE_FLOOR * abs(mean.x);
    // Above 0 also where light is negative, as rounding can make it.
    const float limit = max(max(usual, 0.0) + 1e-6, l - params.phiColor * light.a);
    return l > limit ? vec4(light.rgb * (limit / l), light.a) : light;
}

/// The first two moments of a neighbour that count for the variance. Differences between pixels are noise only where nothing else
/// is known: with several samples, each pixel knows the variance of its own mean.
vec2 momentsBeside(vec4 texel) {
    return params.samples > 1.0 ? vec2(0.0, texel.y * texel.y) : unpackedMoments(texel).xy;
}

/// `sum` has the weighted moments and the weights of all neighbours.
void storeDeviation(ivec2 at, vec3 sum) {
    const vec2 mean = sum.xy / max(sum.z, 1e-30);
    const float frames = imageLoad(moments, at).w;
    const float boost = params.samples > 1.0 ? svgfSampledBoost(frames) : svgfBoost(BOOST, frames);
    const float deviation = boost * sqrt(max(mean.y - mean.x * mean.x, 0.0));
    vec4 light = vec4(LOAD_HALF4(color, at).rgb, min(deviation, MAX_HALF));
    if (FIREFLIES) light = withoutFirefly(at, light, frames);
    STORE_HALF4(color, at, light);
}
