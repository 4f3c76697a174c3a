#version 460
#extension GL_EXT_scalar_block_layout : require
// One level of the a-trous filter of visibility; the last writes the picture. docs/denoising.md, Visibility, step 4.
#extension GL_EXT_control_flow_attributes : require
#include "denoise/methods/svgf/svgf_params.h"
#include "denoise/methods/visibility/shaders/visibility_texel.glsl"
#include "shaders/common/filter_image.glsl"

layout(constant_id = 3) const bool BLUR_VARIANCE = true;  // the step is 1
layout(constant_id = 4) const bool LAST = false;

layout(set = 0, binding = 0, scalar) uniform Params {
    SvgfFilterParams params;
};
READ_UINT2(1, surfaces);
READ_UINT1(2, signal);
WRITE_UINT1(3, filtered);                                              // unless LAST
layout(set = 0, binding = 4, rgba32f) uniform writeonly image2D picture;  // if LAST

#include "denoise/methods/svgf/shaders/svgf_weights.glsl"
#include "denoise/stages/atrous/kernel.glsl"

const ivec2 BLOCK = ivec2(1, SVGF_COLUMN);
const int REACH = 1;
const float TENT[2] = float[2](2.0 / 4.0, 1.0 / 4.0);
const float LOG2_E = 1.44269504;
const int PAIRS = 4;  // of opposite taps, numbered from 1 on

int pairOf(ivec2 from) {
    return abs(3 * from.y + from.x);
}

ivec2 tapOf(int pair) {
    return ivec2((pair + 1) % 3 - 1, (pair + 1) / 3);
}

struct Tap {
    vec2 signal;  // visibility and deviation
    Surface surface;
    bool counts;
};

struct Centre {
    SurfaceCentre surface;
    float perDepth[PAIRS + 1];
    vec2 signal;
    float scale;  // of a difference of visibility to an exponent of 2
    vec2 sum;     // of weighted visibility, and of the weights
    float squares;  // of weighted deviations
};

float kernel(ivec2 from) {
    return TENT[abs(from.x)] * TENT[abs(from.y)];
}

ivec2 nearestInside(ivec2 at) {
    return clamp(at, ivec2(0), ivec2(params.width, params.height) - 1);
}

Tap loadTap(ivec2 at) {
    const ivec2 inside = nearestInside(at);
    const vec2 there = unpackedSignal(LOAD_UINT1(signal, inside));
    return Tap(there, surfaceAt(inside), at == inside && there.y >= 0.0);
}

/// Negative where nothing is seen, and outside of the picture.
float deviationAt(ivec2 at) {
    const ivec2 inside = nearestInside(at);
    return at == inside ? unpackedSignal(LOAD_UINT1(signal, inside)).y : NOTHING_SEEN;
}

// Deviations of the block's pixels and of those next to them; loaded if BLUR_VARIANCE.
float deviationsAround[3 * (SVGF_COLUMN + 2)];

void loadDeviationsAround(ivec2 first) {
    [[unroll]] for (int i = 0; i < deviationsAround.length(); ++i)
        deviationsAround[i] = deviationAt(first - 1 + ivec2(i % 3, i / 3));
}

/// The root of the mean variance of the 3x3 pixels: a single pixel's variance is as noisy as its mean.
float blurredDeviation(int number, float own) {
    if (!BLUR_VARIANCE) return own;
    vec2 sum = vec2(0.0);
    [[unroll]] for (int i = 0; i < 9; ++i) {
        const float deviation = deviationsAround[number * 3 + i];
        const float weight = float((2 - abs(i % 3 - 1)) * (2 - abs(i / 3 - 1)));
        if (deviation >= 0.0) sum += weight * vec2(deviation * deviation, 1.0);
    }
    return sqrt(sum.x / max(sum.y, 1.0));
}

Centre begin(ivec2 at, int number) {
    const Tap tap = loadTap(at);
    Centre centre;
    centre.surface = centreOf(tap.surface, at);
    [[unroll]] for (int pair = 1; pair <= PAIRS; ++pair)
        centre.perDepth[pair] = perDepthOf(centre.surface, tapOf(pair));
    centre.signal = tap.signal;
    const float tolerance =
        params.phiColor * blurredDeviation(number, tap.signal.y) + SVGF_LUMINANCE_FLOOR * tap.signal.x + 1e-6;
    centre.scale = tap.counts ? LOG2_E / tolerance : 0.0;
    const float weight = tap.counts ? kernel(ivec2(0)) : 0.0, deviation = weight * tap.signal.y;
    centre.sum = weight * vec2(tap.signal.x, 1.0);
    centre.squares = deviation * deviation;
    return centre;
}

void addTo(inout Centre centre, Tap tap, ivec2 from) {
    const float exponent = surfaceExponent(centre.surface, tap.surface, centre.perDepth[pairOf(from)]) -
                           abs(centre.signal.x - tap.signal.x) * centre.scale;
    const float weight = tap.counts ? kernel(from) * exp2(exponent) : 0.0, deviation = weight * tap.signal.y;
    centre.sum += weight * vec2(tap.signal.x, 1.0);
    centre.squares += deviation * deviation;
}

/// A surface is seen.
bool isFiltered(Centre centre) {
    return centre.signal.y != NOTHING_SEEN;
}

void store(ivec2 at, Centre centre) {
    if (at.x >= int(params.width) || at.y >= int(params.height)) return;
    vec2 result = centre.signal;
    if (isFiltered(centre) && centre.sum.y > 0.0)
        result = vec2(centre.sum.x, sqrt(centre.squares)) / centre.sum.y;
    if (LAST)
        imageStore(picture, at, vec4(vec3(clamp(result.x, 0.0, 1.0)), 1.0));
    else
        STORE_UINT1(filtered, at, packedSignal(result));
}

#include "denoise/stages/atrous/level.glsl"

void main() {
    const ivec2 first = firstOfBlock(ivec2(gl_GlobalInvocationID.xy));
    if (!inPicture(first)) return;
    if (BLUR_VARIANCE) loadDeviationsAround(first);
    filterBlock(first);
}

#ifdef LIMPID_FILTER_BUFFERS
layout(local_size_x = 64, local_size_y = 2) in;
#else
layout(local_size_x = 8, local_size_y = 8) in;
#endif
