// One level of the variance-guided a-trous filter: docs/denoising.md, SVGF, step 6. With LIMPID_STABILISES the last
// level, which also stabilises: step 7.
#extension GL_EXT_control_flow_attributes : require
#include "denoise/methods/svgf/svgf_params.h"
#include "shaders/common/filter_image.glsl"

layout(constant_id = 3) const bool BLUR_VARIANCE = true;
layout(constant_id = 4) const bool WIDE = true;  // 5x5 taps, else 3x3
layout(constant_id = 6) const bool SIDE_BY_SIDE = false;  // the step is 1: pixels of a block are neighbours
layout(constant_id = 8) const bool LOOKS = false;  // compare with the mean luminance of like taps, not with the own one
layout(constant_id = 9) const bool DAMP_OUTLIERS = false;  // a pixel noisier than its taps counts less in its own mean

layout(set = 0, binding = 0, scalar) uniform Params {
    SvgfFilterParams params;
};
READ_UINT2(1, surfaces);
READ_HALF4(2, signal);
WRITE_HALF4(3, filtered);
#ifdef LIMPID_STABILISES
#include "denoise/methods/svgf/shaders/svgf_moments.glsl"
#include "denoise/methods/svgf/shaders/svgf_stable.glsl"
READ_UINT1(4, stablePast);  // svgf_stable.glsl
WRITE_UINT1(5, stable);
layout(set = 0, binding = 6, rgba16f) uniform readonly image2D moments;
#endif

#include "denoise/methods/svgf/shaders/svgf_weights.glsl"

#include "denoise/stages/atrous/kernel.glsl"

const ivec2 BLOCK = ivec2(1, SVGF_COLUMN);
const int REACH = WIDE ? 2 : 1;
const float TENT[3] = float[3](2.0 / 4.0, 1.0 / 4.0, 0.0);
const float LOG2_E = 1.44269504;

// Deviations of the block's pixels and of those next to them; loaded if BLUR_VARIANCE and SIDE_BY_SIDE.
float deviationsAround[3 * (SVGF_COLUMN + 2)];

struct Tap {
    vec4 light;  // and its deviation; negative: nothing is seen
    float luminance;
    Surface surface;
    bool counts;
};

// Opposite taps of the 5x5 form a pair, numbered from 1 to PAIRS.
const int PAIRS = 12;

int pairOf(ivec2 from) {
    return abs(5 * from.y + from.x);
}

ivec2 tapOf(int pair) {
    return ivec2((pair + 2) % 5 - 2, (pair + 2) / 5);
}

struct Centre {
    SurfaceCentre surface;
    float perDepth[PAIRS + 1];  // by pair
    float luminance, luminanceScale;
    vec2 differences;  // sum of weighted differences from the luminance, and of the weights; only if LOOKS
    float exponents[9];  // of the surface's weights of the 3x3 taps; only if KEEPS_EXPONENTS
    vec4 sum;       // of weighted light, and of the weights
    float squares;  // sum of squared weighted deviations
    float squaresOfTaps;  // sum of weighted squared deviations, without the pixel's own; only if DAMP_OUTLIERS
    bool seen;
#ifdef LIMPID_STABILISES
    uint stablePast;
    float frames;
#endif
};

/// Scales a difference of luminance to an exponent of 2.
float luminanceScaleOf(float luminance, float deviation) {
    return LOG2_E / (params.phiColor * deviation + SVGF_LUMINANCE_FLOOR * abs(luminance) + 1e-6);
}

/// The weight of a tap by its offset.
float kernel(ivec2 from) {
    return WIDE ? splineWeight(from) : TENT[abs(from.x)] * TENT[abs(from.y)];
}

ivec2 nearestInside(ivec2 at) {
    return clamp(at, ivec2(0), ivec2(params.width, params.height) - 1);
}

Tap loadTap(ivec2 at) {
    const ivec2 inside = nearestInside(at);
    const vec4 light = LOAD_HALF4(signal, inside);
    return Tap(light, luminance(light.rgb), surfaceAt(inside), at == inside && light.a >= 0.0);
}

/// Negative where nothing is seen, and outside of the picture.
float deviationAt(ivec2 at) {
    const ivec2 inside = nearestInside(at);
    const float deviation = LOAD_HALF4_ALPHA(signal, inside);
    return at == inside ? deviation : SVGF_NOTHING_SEEN;
}

void loadDeviationsAround(ivec2 first) {
    [[unroll]] for (int i = 0; i < deviationsAround.length(); ++i)
        deviationsAround[i] = deviationAt(first - 1 + ivec2(i % 3, i / 3));
}

/// `at` is the pixel with this number in the block.
float deviationNextTo(ivec2 at, int number, ivec2 from) {
    return SIDE_BY_SIDE ? deviationsAround[(number + 1 + from.y) * 3 + 1 + from.x] : deviationAt(at + from);
}

/// The root of the mean variance of the 3x3 pixels: a single pixel's variance is as noisy as its light.
float blurredDeviation(ivec2 at, int number, float own) {
    if (!BLUR_VARIANCE) return own;
    vec2 sum = 4.0 * vec2(own * own, 1.0);
    [[unroll]] for (int j = -1; j <= 1; ++j) {
        [[unroll]] for (int i = -1; i <= 1; ++i) {
            if (i == 0 && j == 0) continue;
            const float deviation = deviationNextTo(at, number, ivec2(i, j));
            const float weight = float((2 - abs(i)) * (2 - abs(j)));
            if (deviation >= 0.0) sum += weight * vec2(deviation * deviation, 1.0);
        }
    }
    return sqrt(sum.x / sum.y);
}

Centre begin(ivec2 at, int number) {
    const Tap tap = loadTap(at);
    Centre centre;
    centre.surface = centreOf(tap.surface, at);
    [[unroll]] for (int pair = 1; pair <= PAIRS; ++pair) {
        const ivec2 from = tapOf(pair);
        if (max(abs(from.x), abs(from.y)) <= REACH) centre.perDepth[pair] = perDepthOf(centre.surface, from);
    }
    centre.seen = tap.counts;
    centre.luminance = tap.luminance;
    centre.luminanceScale = luminanceScaleOf(tap.luminance, blurredDeviation(at, number, tap.light.a));
    centre.differences = vec2(0.0, 1.0);
    const float weight = kernel(ivec2(0));
    centre.sum = weight * vec4(tap.light.rgb, 1.0);
    centre.squares = weight * weight * tap.light.a * tap.light.a;
    centre.squaresOfTaps = 0.0;
    // Loaded before the taps, so that its latency is hidden behind theirs.
#ifdef LIMPID_STABILISES
    centre.stablePast = LOAD_UINT1(stablePast, nearestInside(at));
    centre.frames = imageLoad(moments, nearestInside(at)).w;
#endif
    return centre;
}

/// The second visit of a tap then needs its light alone. Those of 5x5 taps would take too many registers.
const bool KEEPS_EXPONENTS = LOOKS && !WIDE;

float exponentOf(Centre centre, Tap tap, ivec2 from) {
    return surfaceExponent(centre.surface, tap.surface, centre.perDepth[pairOf(from)]);
}

int numberOfTap(ivec2 from) {
    return 3 * from.y + from.x + 4;
}

/// How far a tap shows the same as the centre: 0 to 1.
float likeness(Centre centre, Tap tap, float exponent) {
    const float difference = abs(centre.luminance - tap.luminance) * centre.luminanceScale;
    return tap.counts ? exp2(exponent - difference) : 0.0;
}

void lookAt(inout Centre centre, Tap tap, ivec2 from) {
    const float exponent = exponentOf(centre, tap, from);
    if (KEEPS_EXPONENTS) centre.exponents[numberOfTap(from)] = exponent;
    centre.differences += likeness(centre, tap, exponent) * vec2(tap.luminance - centre.luminance, 1.0);
}

void looked(inout Centre centre) {
    centre.luminance += centre.differences.x / centre.differences.y;
}

void addTo(inout Centre centre, Tap tap, ivec2 from) {
    const float exponent =
        KEEPS_EXPONENTS ? centre.exponents[numberOfTap(from)] : exponentOf(centre, tap, from);
    const float weight = kernel(from) * likeness(centre, tap, exponent);
    centre.sum += weight * vec4(tap.light.rgb, 1.0);
    const float deviation = weight * tap.light.a;
    centre.squares += deviation * deviation;
    if (DAMP_OUTLIERS) centre.squaresOfTaps += deviation * tap.light.a;
}

/// Takes back a part of the pixel's own weight where the taps that it resembles are less noisy. `own`: its light and
/// deviation. A pixel that has just seen a firefly takes in all its neighbours, but they do not take it in. Without
/// this it would stay a dot, a quarter as bright after each level.
void dampOutlier(inout Centre centre, vec4 own) {
    const float weight = kernel(ivec2(0)), square = own.a * own.a;
    const float ofTaps = (centre.squaresOfTaps + SVGF_MIN_WEIGHTS * square) / (centre.sum.a - weight + SVGF_MIN_WEIGHTS);
    const float share = square > 0.0 ? min(sqrt(ofTaps / square), 1.0) : 1.0;
    centre.sum -= (1.0 - share) * weight * vec4(own.rgb, 1.0);
    centre.squares = max(centre.squares - (1.0 - share * share) * weight * weight * square, 0.0);
}

#ifdef LIMPID_STABILISES
/// Stabilised light: a mean over frames, as far as the noise that the filter left explains their difference.
vec3 mixedWithPast(vec4 now, vec3 past, float frames) {
    const float l = luminance(now.rgb), change = abs(luminance(past) - l);
    const float noise = params.stabilisationNoise * max(now.a, 0.0) + SVGF_LUMINANCE_FLOOR * abs(l);
    // Only anti-lag leaves less than two frames where there was a history.
    const bool hadNone = frames == 1.0 || frames == 0.0;
    const float weight = hadNone ? 1.0 : max(params.stabilisationAlpha, min(1.0 / frames, 0.5));
    return mix(now.rgb, past, (1.0 - weight) * min(noise / max(change, 1e-30), 1.0));
}
#endif

void store(ivec2 at, Centre centre) {
    if (at.x >= int(params.width) || at.y >= int(params.height)) return;
    const vec4 own = DAMP_OUTLIERS || !centre.seen ? LOAD_HALF4(signal, at) : vec4(0.0);
    if (DAMP_OUTLIERS) dampOutlier(centre, own);
    vec4 result = vec4(centre.sum.rgb, sqrt(centre.squares)) / centre.sum.a;
#ifdef LIMPID_STABILISES
    result.rgb = mixedWithPast(result, unpackedStable(centre.stablePast), centre.frames);
#endif
    if (!centre.seen) result = own;
    STORE_HALF4(filtered, at, result);
#ifdef LIMPID_STABILISES
    STORE_UINT1(stable, at, packedStable(result.rgb));
#endif
}

bool isFiltered(Centre centre) {
    return centre.seen;
}

#define LIMPID_LEVEL_LOOKS_FIRST
#include "denoise/stages/atrous/level.glsl"

void main() {
    const ivec2 first = firstOfBlock(ivec2(gl_GlobalInvocationID.xy));
    if (!inPicture(first)) return;
    if (BLUR_VARIANCE && SIDE_BY_SIDE) loadDeviationsAround(first);
    filterBlock(first);
}

#ifdef LIMPID_FILTER_BUFFERS
layout(local_size_x = 64, local_size_y = 2) in;
#else
layout(local_size_x = 8, local_size_y = 8) in;
#endif
