// One level of the variance-guided a-trous filter: docs/denoising.md, SVGF, step 6. With LIMPID_STABILISES the last
// level, which also stabilises: step 7. With BOTH it filters two signals, which share the surfaces and most of the
// weights.
#extension GL_EXT_control_flow_attributes : require
#include "denoise/methods/svgf/svgf_params.h"
#include "shaders/common/filter_image.glsl"

layout(constant_id = 3) const bool BLUR_VARIANCE = true;
layout(constant_id = 4) const bool WIDE = true;  // 5x5 taps, else 3x3
layout(constant_id = 6) const bool SIDE_BY_SIDE = false;  // the step is 1: pixels of a block are neighbours
layout(constant_id = 8) const bool LOOKS = false;  // compare with the mean luminance of like taps, not with the own one
layout(constant_id = 9) const bool DAMP_OUTLIERS = false;  // a pixel noisier than its taps counts less in its own mean
layout(constant_id = 10) const bool BOTH = false;  // filter a second signal, too; only that one compares roughness

layout(set = 0, binding = 0, scalar) uniform Params {
    SvgfFilterParams params;
};
READ_UINT2(1, surfaces);
READ_HALF4(2, signalA);
READ_HALF4(3, signalB);  // this and the other images B: only with BOTH
WRITE_HALF4(4, filteredA);
WRITE_HALF4(5, filteredB);
#ifdef LIMPID_STABILISES
#include "denoise/methods/svgf/shaders/svgf_moments.glsl"
#include "denoise/methods/svgf/shaders/svgf_stable.glsl"
READ_UINT1(6, stablePastA);  // svgf_stable.glsl
READ_UINT1(7, stablePastB);
WRITE_UINT1(8, stableA);
WRITE_UINT1(9, stableB);
layout(set = 0, binding = 10, rgba16f) uniform readonly image2D momentsA;
layout(set = 0, binding = 11, rgba16f) uniform readonly image2D momentsB;
#endif

#include "denoise/methods/svgf/shaders/svgf_weights.glsl"

#include "denoise/stages/atrous/kernel.glsl"

const ivec2 BLOCK = ivec2(1, SVGF_COLUMN);
const int REACH = WIDE ? 2 : 1;
const float TENT[3] = float[3](2.0 / 4.0, 1.0 / 4.0, 0.0);
const float LOG2_E = 1.44269504;

// Deviations of both signals, of the block and of the pixels next to it; loaded if BLUR_VARIANCE and SIDE_BY_SIDE.
vec2 deviationsAround[3 * (SVGF_COLUMN + 2)];

/// Light of one signal.
struct Light {
    vec4 light;  // and its deviation; negative: nothing is seen
    float luminance;
};

struct Tap {
    Light a, b;
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

/// What the filter collects of one signal.
struct Mean {
    float luminance, luminanceScale;
    vec2 differences;  // sum of weighted differences from the luminance, and of the weights; only if LOOKS
    vec4 sum;       // of weighted light, and of the weights
    float squares;  // sum of squared weighted deviations
    float squaresOfTaps;  // sum of weighted squared deviations, without the pixel's own; only if DAMP_OUTLIERS
#ifdef LIMPID_STABILISES
    uint stablePast;
    float frames;
#endif
};

struct Centre {
    SurfaceCentre surface;
    float perDepth[PAIRS + 1];  // by pair
    float exponents[9];  // of the surface's weights of the 3x3 taps; only if KEEPS_EXPONENTS
    Mean a, b;
    bool seen;
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

Light lightOf(vec4 texel) {
    return Light(texel, luminance(texel.rgb));
}

Tap loadTap(ivec2 at) {
    const ivec2 inside = nearestInside(at);
    const Light a = lightOf(LOAD_HALF4(signalA, inside));
    const Light b = BOTH ? lightOf(LOAD_HALF4(signalB, inside)) : a;
    return Tap(a, b, surfaceAt(inside), at == inside && a.light.a >= 0.0);
}

/// Of both signals. Negative where nothing is seen, and outside of the picture.
vec2 deviationsAt(ivec2 at) {
    const ivec2 inside = nearestInside(at);
    const float a = LOAD_HALF4_ALPHA(signalA, inside);
    const vec2 deviations = vec2(a, BOTH ? LOAD_HALF4_ALPHA(signalB, inside) : a);
    return at == inside ? deviations : vec2(SVGF_NOTHING_SEEN);
}

void loadDeviationsAround(ivec2 first) {
    [[unroll]] for (int i = 0; i < deviationsAround.length(); ++i)
        deviationsAround[i] = deviationsAt(first - 1 + ivec2(i % 3, i / 3));
}

/// `at` is the pixel with this number in the block.
vec2 deviationsNextTo(ivec2 at, int number, ivec2 from) {
    return SIDE_BY_SIDE ? deviationsAround[(number + 1 + from.y) * 3 + 1 + from.x] : deviationsAt(at + from);
}

/// The root of the mean variance of the 3x3 pixels: a single pixel's variance is as noisy as its light.
vec2 blurredDeviations(ivec2 at, int number, vec2 own) {
    if (!BLUR_VARIANCE) return own;
    vec3 sum = 4.0 * vec3(own * own, 1.0);
    [[unroll]] for (int j = -1; j <= 1; ++j) {
        [[unroll]] for (int i = -1; i <= 1; ++i) {
            if (i == 0 && j == 0) continue;
            const vec2 deviations = deviationsNextTo(at, number, ivec2(i, j));
            const float weight = float((2 - abs(i)) * (2 - abs(j)));
            if (deviations.x >= 0.0) sum += weight * vec3(deviations * deviations, 1.0);
        }
    }
    return sqrt(sum.xy / sum.z);
}

/// `deviation` is the blurred one.
Mean beginMean(Light own, float deviation) {
    Mean mean;
    mean.luminance = own.luminance;
    mean.luminanceScale = luminanceScaleOf(own.luminance, deviation);
    mean.differences = vec2(0.0, 1.0);
    const float weight = kernel(ivec2(0));
    mean.sum = weight * vec4(own.light.rgb, 1.0);
    mean.squares = weight * weight * own.light.a * own.light.a;
    mean.squaresOfTaps = 0.0;
    return mean;
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
    const vec2 deviations = blurredDeviations(at, number, vec2(tap.a.light.a, tap.b.light.a));
    centre.a = beginMean(tap.a, deviations.x);
    if (BOTH) centre.b = beginMean(tap.b, deviations.y);
    // Loaded before the taps, so that its latency is hidden behind theirs.
#ifdef LIMPID_STABILISES
    const ivec2 inside = nearestInside(at);
    centre.a.stablePast = LOAD_UINT1(stablePastA, inside);
    centre.a.frames = imageLoad(momentsA, inside).w;
    if (BOTH) centre.b.stablePast = LOAD_UINT1(stablePastB, inside);
    if (BOTH) centre.b.frames = imageLoad(momentsB, inside).w;
#endif
    return centre;
}

/// The second visit of a tap then needs its light alone. Those of 5x5 taps would take too many registers, and so would
/// those of two signals.
const bool KEEPS_EXPONENTS = LOOKS && !WIDE && !BOTH;

int numberOfTap(ivec2 from) {
    return 3 * from.y + from.x + 4;
}

/// Of the surface's weights for both signals.
vec2 exponentsOf(Centre centre, Tap tap, ivec2 from) {
    const float geometry = geometryExponent(centre.surface, tap.surface, centre.perDepth[pairOf(from)]);
    const float all = geometry + roughnessExponent(centre.surface.surface, tap.surface);
    return vec2(BOTH ? geometry : all, all);
}

/// How far a tap shows the same as the centre: 0 to 1.
float likeness(Mean mean, Light tap, float exponent) {
    return exp2(exponent - abs(mean.luminance - tap.luminance) * mean.luminanceScale);
}

void lookAt(inout Mean mean, Light tap, float exponent) {
    mean.differences += likeness(mean, tap, exponent) * vec2(tap.luminance - mean.luminance, 1.0);
}

void lookAt(inout Centre centre, Tap tap, ivec2 from) {
    const vec2 exponents = exponentsOf(centre, tap, from);
    if (KEEPS_EXPONENTS) centre.exponents[numberOfTap(from)] = exponents.x;
    if (!tap.counts) return;
    lookAt(centre.a, tap.a, exponents.x);
    if (BOTH) lookAt(centre.b, tap.b, exponents.y);
}

void looked(inout Centre centre) {
    centre.a.luminance += centre.a.differences.x / centre.a.differences.y;
    if (BOTH) centre.b.luminance += centre.b.differences.x / centre.b.differences.y;
}

void addTo(inout Mean mean, Light tap, float exponent, float kernelWeight) {
    const float weight = kernelWeight * likeness(mean, tap, exponent);
    mean.sum += weight * vec4(tap.light.rgb, 1.0);
    const float deviation = weight * tap.light.a;
    mean.squares += deviation * deviation;
    if (DAMP_OUTLIERS) mean.squaresOfTaps += deviation * tap.light.a;
}

void addTo(inout Centre centre, Tap tap, ivec2 from) {
    const vec2 exponents =
        KEEPS_EXPONENTS ? vec2(centre.exponents[numberOfTap(from)]) : exponentsOf(centre, tap, from);
    const float kernelWeight = tap.counts ? kernel(from) : 0.0;
    addTo(centre.a, tap.a, exponents.x, kernelWeight);
    if (BOTH) addTo(centre.b, tap.b, exponents.y, kernelWeight);
}

/// Takes back a part of the pixel's own weight where the taps that it resembles are less noisy. `own`: its light and
/// deviation. A pixel that has just seen a firefly takes in all its neighbours, but they do not take it in. Without
/// this it would stay a dot, a quarter as bright after each level.
void dampOutlier(inout Mean mean, vec4 own) {
    const float weight = kernel(ivec2(0)), square = own.a * own.a;
    const float ofTaps = (mean.squaresOfTaps + SVGF_MIN_WEIGHTS * square) / (mean.sum.a - weight + SVGF_MIN_WEIGHTS);
    const float share = square > 0.0 ? min(sqrt(ofTaps / square), 1.0) : 1.0;
    mean.sum -= (1.0 - share) * weight * vec4(own.rgb, 1.0);
    mean.squares = max(mean.squares - (1.0 - share * share) * weight * weight * square, 0.0);
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

/// `own` is the pixel's light and deviation; only with DAMP_OUTLIERS or if nothing is seen.
vec4 resultOf(Mean mean, vec4 own, bool seen) {
    if (DAMP_OUTLIERS) dampOutlier(mean, own);
    vec4 result = vec4(mean.sum.rgb, sqrt(mean.squares)) / mean.sum.a;
#ifdef LIMPID_STABILISES
    result.rgb = mixedWithPast(result, unpackedStable(mean.stablePast), mean.frames);
#endif
    return seen ? result : own;
}

void store(ivec2 at, Centre centre) {
    if (at.x >= int(params.width) || at.y >= int(params.height)) return;
    const bool needsOwn = DAMP_OUTLIERS || !centre.seen;
    const vec4 a = resultOf(centre.a, needsOwn ? LOAD_HALF4(signalA, at) : vec4(0.0), centre.seen);
    STORE_HALF4(filteredA, at, a);
#ifdef LIMPID_STABILISES
    STORE_UINT1(stableA, at, packedStable(a.rgb));
#endif
    if (!BOTH) return;
    const vec4 b = resultOf(centre.b, needsOwn ? LOAD_HALF4(signalB, at) : vec4(0.0), centre.seen);
    STORE_HALF4(filteredB, at, b);
#ifdef LIMPID_STABILISES
    STORE_UINT1(stableB, at, packedStable(b.rgb));
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
