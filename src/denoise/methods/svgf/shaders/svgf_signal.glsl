// This frame's light of one signal, and the deviation that follows from its moments. Used by reprojection and
// anti-lag. The including shader declares `params` beforehand, with width, height and minAlbedo; bindings 1 to 4 and
// constants 0, 2 and 5 are used here. docs/denoising.md, SVGF, steps 3 and 4.
#include "denoise/stages/guides.glsl"
#include "denoise/methods/svgf/shaders/svgf_moments.glsl"
#include "denoise/methods/svgf/svgf_params.h"
#include "shaders/common/filter_image.glsl"

layout(constant_id = 0) const bool TWO_LIGHTS = false;   // light is lightA + lightB, else the first
layout(constant_id = 5) const bool TWO_ALBEDOS = false;  // albedo likewise
layout(constant_id = 2) const bool BOOST = true;

const float MOST_VARIANCE = MAX_HALF * MAX_HALF;  // its root is stored

READ_LAYER(1, lightA);
READ_LAYER(2, lightB);
READ_LAYER(3, albedoA);
READ_LAYER(4, albedoB);

/// With the mean squared deviation of the samples' luminance as alpha.
vec4 lightAt(ivec2 at) {
    vec4 light = LOAD_LAYER(lightA, at);
    if (TWO_LIGHTS) light += LOAD_LAYER(lightB, at);
    return light;
}

vec3 demodulated(vec3 light, ivec2 at) {
    vec4 albedo = LOAD_WIDE_LAYER(albedoA, at);
    if (TWO_ALBEDOS) albedo += LOAD_WIDE_LAYER(albedoB, at);
    const vec3 x = finiteOr(light, vec3(0.0)) / modulation(albedo, params.minAlbedo);
    return clamp(x, -MAX_HALF, MAX_HALF);
}

/// The first two moments of the luminance of `x`, the light without albedo. The variance of the mean over the frame's
/// samples adds to the second one; its samples are divided by the albedo like their mean.
vec2 momentsOf(vec3 x, vec4 light) {
    const float l = luminance(x), before = luminance(light.rgb), ratio = before > 1e-6 ? l / before : 0.0;
    const float squares = light.a > 0.0 && !isinf(light.a) ? light.a : 0.0;  // NaN is not above 0
    return vec2(l, l * l + min(params.ofMean * ratio * ratio * squares, MOST_VARIANCE));
}

/// The fourth component of `color`: the expected deviation of the luminance, or SVGF_STILL_YOUNG.
float deviationOf(vec4 moments) {
    if (moments.w < SVGF_YOUNG) return SVGF_STILL_YOUNG;
    return min(svgfBoost(BOOST, moments.w) * sqrt(varianceOf(moments)), MAX_HALF);
}
