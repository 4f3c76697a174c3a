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

READ_LAYER(1, lightA);
READ_LAYER(2, lightB);
READ_LAYER(3, albedoA);
READ_LAYER(4, albedoB);

vec3 lightAt(ivec2 at) {
    vec3 light = LOAD_LAYER(lightA, at).rgb;
    if (TWO_LIGHTS) light += LOAD_LAYER(lightB, at).rgb;
    return light;
}

vec3 demodulated(vec3 light, ivec2 at) {
    vec4 albedo = LOAD_WIDE_LAYER(albedoA, at);
    if (TWO_ALBEDOS) albedo += LOAD_WIDE_LAYER(albedoB, at);
    const vec3 x = finiteOr(light, vec3(0.0)) / modulation(albedo, params.minAlbedo);
    return clamp(x, -MAX_HALF, MAX_HALF);
}

/// The fourth component of `color`: the expected deviation of the luminance, or SVGF_STILL_YOUNG.
float deviationOf(vec4 moments) {
    if (moments.w < SVGF_YOUNG) return SVGF_STILL_YOUNG;
    return min(svgfBoost(BOOST, moments.w) * sqrt(varianceOf(moments)), MAX_HALF);
}
