#version 460
#extension GL_EXT_scalar_block_layout : require
// Replaces the first level of the filter where the history is short: a mean over a wider neighbourhood, in which each
// pixel weighs as much as it has frames. docs/denoising.md, SVGF, step 6.
#include "denoise/methods/svgf/svgf_params.h"
#include "shaders/common/filter_image.glsl"

#ifdef LIMPID_FILTER_BUFFERS
layout(local_size_x = 64, local_size_y = 2) in;
#else
layout(local_size_x = 8, local_size_y = 8) in;
#endif

layout(set = 0, binding = 0, scalar) uniform Params {
    SvgfFilterParams params;
};
READ_UINT2(1, surfaces);
layout(set = 0, binding = 2, rgba16f) uniform readonly image2D moments;
READ_HALF4(3, signal);
WRITE_HALF4(4, filtered);

#include "denoise/methods/svgf/shaders/svgf_weights.glsl"

struct Sum {
    vec4 light;     // weighted, and the weights
    float squares;  // of weighted deviations
};

/// The largest r with r^2 frames <= youngRadius^2, which floats compute exactly.
int radiusOf(float frames) {
    const float square = float(params.youngRadius * params.youngRadius);
    int radius = 0;
    while (float((radius + 1) * (radius + 1)) * max(frames, 1.0) <= square) ++radius;
    return radius;
}

float tent(ivec2 from, int radius) {
    return float((radius + 1 - abs(from.x)) * (radius + 1 - abs(from.y)));
}

void addTap(inout Sum sum, SurfaceCentre centre, ivec2 at, ivec2 from, int radius) {
    const ivec2 there = at + from;
    const ivec2 inside = clamp(there, ivec2(0), ivec2(params.width, params.height) - 1);
    const vec4 light = LOAD_HALF4(signal, inside);
    if (inside != there || light.a < 0.0) return;
    const float surface = surfaceExponent(centre, surfaceAt(inside), perDepthOf(centre, from));
    const float likeness = from == ivec2(0) ? 1.0 : exp2(surface);
    const float weight = tent(from, radius) * imageLoad(moments, inside).w * likeness;
    sum.light += weight * vec4(light.rgb, 1.0);
    sum.squares += weight * weight * light.a * light.a;
}

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(params.width) || at.y >= int(params.height)) return;
    const float frames = imageLoad(moments, at).w;
    if (frames >= SVGF_YOUNG || LOAD_HALF4_ALPHA(signal, at) < 0.0) return;
    const SurfaceCentre centre = centreOf(surfaceAt(at), at);
    const int radius = radiusOf(frames);
    Sum sum = Sum(vec4(0.0), 0.0);
    for (int j = -radius; j <= radius; ++j) {
        for (int i = -radius; i <= radius; ++i) addTap(sum, centre, at, ivec2(i, j), radius);
    }
    if (sum.light.a < SVGF_MIN_WEIGHTS) return;
    STORE_HALF4(filtered, at, vec4(sum.light.rgb, sqrt(sum.squares)) / sum.light.a);
}
