// This frame's light of one signal, and the deviation that follows from its moments. Used by reprojection and
// anti-lag. The including shader declares `params` beforehand, with width, height and minAlbedo; bindings 1 to 4 and
// constants 0 and 2 are used here. docs/denoising.md, SVGF, steps 3 and 4.
#include "denoise/stages/guides.glsl"
#include "denoise/methods/svgf/svgf_params.h"
#include "shaders/common/filter_image.glsl"

layout(constant_id = 0) const bool SUM_OF_TWO = false;  // light is lightA + lightB, albedo likewise; else the first

layout(constant_id = 2) const bool BOOST = true;

layout(set = 0, binding = 1, rgba32f) uniform readonly image2D lightA;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D lightB;
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D albedoA;
layout(set = 0, binding = 4, rgba32f) uniform readonly image2D albedoB;

vec3 lightAt(ivec2 at) {
    vec3 light = imageLoad(lightA, at).rgb;
    if (SUM_OF_TWO) light += imageLoad(lightB, at).rgb;
    return light;
}

vec3 demodulated(vec3 light, ivec2 at) {
    vec4 albedo = imageLoad(albedoA, at);
    if (SUM_OF_TWO) albedo += imageLoad(albedoB, at);
    const vec3 x = finiteOr(light, vec3(0.0)) / modulation(albedo, params.minAlbedo);
    return clamp(x, -MAX_HALF, MAX_HALF);
}

/// The fourth component of `color`: the expected deviation of the luminance, or SVGF_STILL_YOUNG.
float deviationOf(vec4 moments) {
    if (moments.w < SVGF_YOUNG) return SVGF_STILL_YOUNG;
    return min(svgfBoost(BOOST, moments.w) * sqrt(max(moments.y - moments.x * moments.x, 0.0)), MAX_HALF);
}
