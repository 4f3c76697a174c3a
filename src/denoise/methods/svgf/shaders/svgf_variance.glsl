// Estimates the deviation of pixels with a short history from the moments of their neighbours. docs/denoising.md,
// SVGF, step 5.
#include "denoise/methods/svgf/svgf_params.h"
#include "shaders/common/filter_image.glsl"

layout(set = 0, binding = 0, scalar) uniform Params {
    SvgfFilterParams params;
};
READ_UINT2(1, surfaces);
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D moments;
UPDATE_HALF4(3, color);

#include "denoise/methods/svgf/shaders/svgf_weights.glsl"

layout(constant_id = 3) const bool BOOST = true;

const int RADIUS = 3;

void addTap(inout vec3 sum, SurfaceCentre centre, ivec2 at, ivec2 from) {
    const ivec2 there = at + from;
    const ivec2 inside = clamp(there, ivec2(0), ivec2(params.width, params.height) - 1);
    const Surface other = surfaceAt(inside);
    const float weight = from == ivec2(0) ? 1.0 : exp2(surfaceExponent(centre, other, perDepthOf(centre, from)));
    const vec4 m = imageLoad(moments, inside);
    if (inside == there && m.w > 0.0) sum += weight * vec3(m.xy, 1.0);
}

bool isYoung(ivec2 at) {
    return at.x < int(params.width) && at.y < int(params.height) && LOAD_HALF4_ALPHA(color, at) == SVGF_STILL_YOUNG;
}

/// Sums weighted moments and weights over the taps of every `step`-th of the 7 rows, from row `first` on.
vec3 rowsSum(ivec2 at, int first, int step) {
    const SurfaceCentre centre = centreOf(surfaceAt(at), at);
    vec3 sum = vec3(0.0);
    for (int j = first - RADIUS; j <= RADIUS; j += step) {
        for (int i = -RADIUS; i <= RADIUS; ++i) addTap(sum, centre, at, ivec2(i, j));
    }
    return sum;
}

/// `sum` is the sum over all rows.
void storeDeviation(ivec2 at, vec3 sum) {
    const vec2 mean = sum.xy / max(sum.z, 1e-30);
    const float boost = svgfBoost(BOOST, imageLoad(moments, at).w);
    const vec3 light = LOAD_HALF4(color, at).rgb;
    STORE_HALF4(color, at, vec4(light, min(boost * sqrt(max(mean.y - mean.x * mean.x, 0.0)), MAX_HALF)));
}
