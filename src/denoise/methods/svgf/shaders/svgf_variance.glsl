// Estimates the deviation of pixels with a short history from the moments of their neighbours. docs/denoising.md,
// SVGF, step 5.
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

const int RADIUS = 3;

bool isYoung(ivec2 at) {
    return at.x < int(params.width) && at.y < int(params.height) && LOAD_HALF4_ALPHA(color, at) == SVGF_STILL_YOUNG;
}

/// `sum` has the weighted moments and the weights of all neighbours.
void storeDeviation(ivec2 at, vec3 sum) {
    const vec2 mean = sum.xy / max(sum.z, 1e-30);
    const float boost = svgfBoost(BOOST, imageLoad(moments, at).w);
    const vec3 light = LOAD_HALF4(color, at).rgb;
    STORE_HALF4(color, at, vec4(light, min(boost * sqrt(max(mean.y - mean.x * mean.x, 0.0)), MAX_HALF)));
}
