// This frame's visibility of a pixel, how its mean is updated, and what the levels start from. Used by accumulation and
// anti-lag. The including shader declares `params` with `VisibilityAlphas alphas` beforehand; bindings 1 and 2 and
// constant 0 are used here. docs/denoising.md, Visibility, steps 2 and 3.
#include "denoise/methods/svgf/shaders/svgf_moments.glsl"
#include "denoise/methods/svgf/svgf_params.h"
#include "denoise/methods/visibility/shaders/visibility_texel.glsl"
#include "denoise/stages/guides.glsl"

layout(constant_id = 0) const bool EMISSION = false;  // it is added

READ_LAYER(1, diffuse);
READ_LAYER(2, emission);

/// Standard deviation of samples of which nothing is known: no values in [0, 1] have a larger one.
const float MAX_DEVIATION = 0.5;

/// In [0, 1]; -1 if the sample is rejected.
float visibilityAt(ivec2 at) {
    float x = LOAD_LAYER(diffuse, at).r;
    if (!isFinite(vec3(x))) return -1.0;
    if (EMISSION) {
        const float seen = LOAD_LAYER(emission, at).r;
        if (isFinite(vec3(seen))) x += seen;
    }
    return clamp(x, 0.0, 1.0);
}

/// First and second moment and fast mean of a history of `frames`, with `x` as the last: `shares` are its weights in
/// the slow and in the fast means.
vec4 withSample(vec4 moments, float x, vec2 shares, float frames) {
    return vec4(mix(moments.xyz, vec3(x, x * x, x), shares.xxy), frames);
}

vec2 sharesOf(float frames) {
    return max(vec2(params.alphas.slow, params.alphas.fast), 1.0 / frames);
}

/// The mean and the deviation that is expected of it, where a surface is seen. `moments` as they are stored.
vec2 signalOf(vec4 moments) {
    if (moments.w <= 0.0) return vec2(1.0, UNKNOWN);
    const float deviation = moments.w < SVGF_YOUNG ? MAX_DEVIATION : sqrt(varianceOf(moments));
    return vec2(moments.x, svgfBoost(true, moments.w) * deviation);
}
