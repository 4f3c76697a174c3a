// Replaces the first level of the filter where the history is short: a mean over a wider neighbourhood, in which each
// pixel weighs as much as it has frames. docs/denoising.md, SVGF, step 6. With LIMPID_ONE_CHANNEL for visibility.
#include "denoise/methods/svgf/svgf_params.h"
#include "shaders/common/filter_image.glsl"

layout(set = 0, binding = 0, scalar) uniform Params {
    SvgfFilterParams params;
};
READ_UINT2(1, surfaces);
layout(set = 0, binding = 2, rgba16f) uniform readonly image2D moments;
#ifdef LIMPID_ONE_CHANNEL
#include "denoise/methods/visibility/shaders/visibility_texel.glsl"
READ_UINT1(3, signal);
WRITE_UINT1(4, filtered);
#define NOTHING_THERE NOTHING_SEEN

vec4 signalAt(ivec2 at) {
    return unpackedSignal(LOAD_UINT1(signal, at)).xxxy;
}

void storeFiltered(ivec2 at, vec4 light) {
    STORE_UINT1(filtered, at, packedSignal(light.ra));
}
#else
READ_HALF4(3, signal);
WRITE_HALF4(4, filtered);
#define NOTHING_THERE SVGF_NOTHING_SEEN

vec4 signalAt(ivec2 at) {
    return LOAD_HALF4(signal, at);
}

void storeFiltered(ivec2 at, vec4 light) {
    STORE_HALF4(filtered, at, light);
}
#endif

#include "denoise/methods/svgf/shaders/svgf_weights.glsl"

struct Sum {
    vec4 light;     // weighted, and the weights
    float squares;  // of weighted deviations
};

/// The largest r with r^2 samples <= youngRadius^2, which floats compute exactly.
int radiusOf(float frames) {
    const float square = float(params.youngRadius * params.youngRadius);
    int radius = 0;
    while (float((radius + 1) * (radius + 1)) * max(params.samples * frames, 1.0) <= square) ++radius;
    return radius;
}

float tent(ivec2 from, int radius) {
    return float((radius + 1 - abs(from.x)) * (radius + 1 - abs(from.y)));
}

void addTap(inout Sum sum, SurfaceCentre centre, ivec2 at, ivec2 from, int radius) {
    const ivec2 there = at + from;
    const ivec2 inside = clamp(there, ivec2(0), ivec2(params.width, params.height) - 1);
    const vec4 light = signalAt(inside);
    if (inside != there || light.a < 0.0) return;
    const float surface = surfaceExponent(centre, surfaceAt(inside), perDepthOf(centre, from));
    const float likeness = from == ivec2(0) ? 1.0 : exp2(surface);
    const float weight = tent(from, radius) * imageLoad(moments, inside).w * likeness;
    sum.light += weight * vec4(light.rgb, 1.0);
    sum.squares += weight * weight * light.a * light.a;
}

bool isYoung(ivec2 at) {
    if (at.x >= int(params.width) || at.y >= int(params.height)) return false;
    const float frames = imageLoad(moments, at).w;
    return frames < SVGF_YOUNG && params.samples * frames <= SVGF_YOUNG && signalAt(at).a != NOTHING_THERE;
}

/// The sum over every `step`-th row, from the number `first` on.
Sum rowsSum(ivec2 at, int first, int step) {
    const SurfaceCentre centre = centreOf(surfaceAt(at), at);
    const int radius = radiusOf(imageLoad(moments, at).w);
    Sum sum = Sum(vec4(0.0), 0.0);
    for (int j = first - radius; j <= radius; j += step) {
        for (int i = -radius; i <= radius; ++i) addTap(sum, centre, at, ivec2(i, j), radius);
    }
    return sum;
}

void store(ivec2 at, Sum sum) {
    if (sum.light.a < SVGF_MIN_WEIGHTS) return;
    storeFiltered(at, vec4(sum.light.rgb, sqrt(sum.squares)) / sum.light.a);
}
