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

/// A neighbour: its surface and its first and second moment. It counts if it lies in the picture and has light.
struct Neighbour {
    Surface surface;
    vec2 moments;
    bool counts;
};

Neighbour neighbourAt(ivec2 at) {
    const ivec2 inside = clamp(at, ivec2(0), ivec2(params.width, params.height) - 1);
    const vec4 m = imageLoad(moments, inside);
    return Neighbour(surfaceAt(inside), m.xy, at == inside && m.w > 0.0);
}

/// Adds weighted moments and the weight. `from` is the neighbour's offset.
void add(inout vec3 sum, SurfaceCentre centre, Neighbour other, ivec2 from) {
    const float weight = from == ivec2(0) ? 1.0 : exp2(surfaceExponent(centre, other.surface, perDepthOf(centre, from)));
    if (other.counts) sum += weight * vec3(other.moments, 1.0);
}

bool isYoung(ivec2 at) {
    return at.x < int(params.width) && at.y < int(params.height) && LOAD_HALF4_ALPHA(color, at) == SVGF_STILL_YOUNG;
}

/// `sum` is the sum over all neighbours.
void storeDeviation(ivec2 at, vec3 sum) {
    const vec2 mean = sum.xy / max(sum.z, 1e-30);
    const float boost = svgfBoost(BOOST, imageLoad(moments, at).w);
    const vec3 light = LOAD_HALF4(color, at).rgb;
    STORE_HALF4(color, at, vec4(light, min(boost * sqrt(max(mean.y - mean.x * mean.x, 0.0)), MAX_HALF)));
}
