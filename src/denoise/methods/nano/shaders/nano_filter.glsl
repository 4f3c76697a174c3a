// Filters one level: a mean of the pixels around, and of the four nearest pixels of the filtered coarser level, with
// the network's weights. With LIMPID_NANO_FINEST the finest level, which is then mixed with SVGF's result.
#include "denoise/methods/nano/shaders/nano_storage.glsl"

#ifdef LIMPID_NANO_FINEST
const int REACH = NANO_FINEST_REACH, GROUPS = NANO_FINEST_LOGIT_GROUPS;
#else
const int REACH = NANO_REACH, GROUPS = NANO_LOGIT_GROUPS;
#endif
#ifdef LIMPID_FILTER_BUFFERS
const int PIXELS = 1;
#else
const int PIXELS = NANO_IMAGE_PIXELS;
#endif
const int EDGE = 2 * REACH + 1, OWN_TAPS = EDGE * EDGE, ALL_TAPS = OWN_TAPS + NANO_COARSER_TAPS;
#ifdef LIMPID_NANO_FINEST
const bool COARSER = true;                            // there is a coarser level
layout(constant_id = 0) const bool STABILISE = true;  // the next frame is stabilised by the result
layout(constant_id = 1) const bool TWO_SIGNALS = true;
layout(constant_id = 2) const uint INPUT_GROUPS = 2u;

layout(set = 0, binding = 0, scalar) uniform Params {
    NanoFinestParams finest;
};
#define params finest.level
READ_HALF4(4, filteredA);
READ_HALF4(5, filteredB);
WRITE_HALF4(6, resultA);
WRITE_HALF4(7, resultB);
WRITE_UINT1(8, stableA);  // svgf_stable.glsl
WRITE_UINT1(9, stableB);
#else
layout(constant_id = 0) const bool COARSER = true;

layout(set = 0, binding = 0, scalar) uniform Params {
    NanoFilterParams params;
};
READ_WEIGHTS(4, weights);
WRITE_TEXELS(5, result);
#endif
READ_TEXELS(1, inputs);
READ_TEXELS(2, light);
READ_TEXELS(3, coarser);

#ifdef LIMPID_NANO_FINEST
#include "denoise/methods/nano/shaders/nano_finest_logits.glsl"
#else
#include "denoise/methods/nano/shaders/nano_logits.glsl"
#endif

/// Of one signal and pixel.
struct Logits {
    Eight values[GROUPS];
};

struct AllLogits {
    Logits pixels[PIXELS];
};

AllLogits logitsOfSignal(uint pixels[PIXELS], uint signal) {
    AllLogits logits;
    [[unroll]] for (int group = 0; group < GROUPS; ++group) {
        const LogitsOfPixels eight = logitsOf(pixels, signal * uint(GROUPS) + uint(group));
        [[unroll]] for (int p = 0; p < PIXELS; ++p) logits.pixels[p].values[group] = eight.values[p];
    }
    return logits;
}

float logit(Logits logits, int number) {
    return logitOf(logits.values[number / 8], number);
}

float largest(Logits logits, int count) {
    float most = logit(logits, 0);
    [[unroll]] for (int i = 1; i < count; ++i) most = max(most, logit(logits, i));
    return most;
}

/// The pixel of the coarser level that is the `number`th of the four nearest ones.
ivec2 coarseTap(ivec2 at, int number) {
    const ivec2 from = ivec2(number % 2, number / 2) - 1 + (at & 1);
    return clamp(at / 2 + from, ivec2(0), ivec2(params.paddedWidth, params.paddedHeight) / 2 - 1);
}

LightPair filtered(ivec2 at, Logits a, Logits b) {
    const int count = COARSER ? ALL_TAPS : OWN_TAPS;
    const vec2 most = vec2(largest(a, count), largest(b, count));
    LightSums sums = LightSums(vec4(0.0), vec4(0.0));
    const ivec2 last = ivec2(params.paddedWidth, params.paddedHeight) - 1;
    [[unroll]] for (int i = 0; i < ALL_TAPS; ++i) {
        if (i >= count) continue;
        uvec4 texel;
        if (i < OWN_TAPS) {
            const ivec2 tap = clamp(at + ivec2(i % EDGE, i / EDGE) - REACH, ivec2(0), last);
            texel = light.texels[uint(tap.y) * params.paddedWidth + uint(tap.x)];
        } else {
            const ivec2 tap = coarseTap(at, i - OWN_TAPS);
            texel = coarser.texels[uint(tap.y) * (params.paddedWidth / 2u) + uint(tap.x)];
        }
        // Not 0, even if the only taps that see a surface have small weights.
        add(sums, lightPairOf(texel), exp(max(vec2(logit(a, i), logit(b, i)) - most, -60.0)));
    }
    return meanOf(sums);
}

#ifdef LIMPID_NANO_FINEST
#include "denoise/methods/nano/shaders/nano_mix.glsl"

float shareOf(Logits logits) {
    return params.strength / (1.0 + exp(logit(logits, ALL_TAPS + 1) - logit(logits, ALL_TAPS)));
}
#endif

/// Where a pixel that is written lies in the tile, and in the picture.
#ifdef LIMPID_NANO_FINEST
ivec2 inPicture(ivec2 written) {
    return written + ivec2(params.innerX, params.innerY);
}
ivec2 inTile(ivec2 written) {
    return inPicture(written) - ivec2(params.tileX, params.tileY);
}
#else
ivec2 inTile(ivec2 written) {
    return written;
}
#endif

void filterPixel(ivec2 written, Logits a, Logits b) {
    const ivec2 at = inTile(written);
    const LightPair own = filtered(at, a, b);
#ifdef LIMPID_NANO_FINEST
    storeMixed(inPicture(written), own.diffuse, own.specular, vec2(shareOf(a), shareOf(b)));
#else
    result.texels[uint(at.y) * params.paddedWidth + uint(at.x)] = packLightPair(own);
#endif
}

void main() {
    const ivec2 first = ivec2(gl_GlobalInvocationID.xy) * ivec2(PIXELS, 1);
    if (first.x >= int(params.width) || first.y >= int(params.height)) return;
    uint pixels[PIXELS];
    [[unroll]] for (int p = 0; p < PIXELS; ++p) {
        const ivec2 at = inTile(ivec2(min(first.x + p, int(params.width) - 1), first.y));
        pixels[p] = uint(at.y) * params.paddedWidth + uint(at.x);
    }
    const AllLogits a = logitsOfSignal(pixels, 0u), b = logitsOfSignal(pixels, 1u);
    [[unroll]] for (int p = 0; p < PIXELS; ++p) {
        if (first.x + p < int(params.width)) filterPixel(first + ivec2(p, 0), a.pixels[p], b.pixels[p]);
    }
}
