#version 460
#extension GL_EXT_scalar_block_layout : require
// For debugging: tells why history.glsl kept or rejected the history of each pixel. It runs after the method's own
// passes, on the same images and with the same functions.
#include "denoise/stages/guides.glsl"
#include "denoise/stages/reproject/lobe.glsl"
#include "denoise/stages/reproject/reasons_params.h"
#include "denoise/stages/surfaces/surface_texel.glsl"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 1) const bool REFLECTIONS = false;  // follow the reflected image first
layout(constant_id = 2) const bool LOBES = false;        // as in svgf_reproject.glsl
layout(constant_id = 3) const bool INSTANCES = true;     // instances must be equal

layout(set = 0, binding = 0, scalar) uniform Params {
    ReasonsParams params;
};
READ_LAYER(1, motion);
READ_LAYER(2, previousNormal);
READ_LAYER(3, reflectionMotion);
READ_UINT2(4, surfaces);
READ_UINT2(5, surfacesBefore);
READ_LAYER(6, framesBefore);  // fourth component: frames of history, when the frame began
READ_LAYER(7, framesNow);     // fourth component: the same when it had ended
layout(set = 0, binding = 8, rg32ui) uniform writeonly uimage2D reasons;  // reasons_params.h
layout(set = 0, binding = 9, rgba8) uniform writeonly image2D shown;      // as colours

struct Past {
    float frames;
};

const Past NO_PAST = Past(0.0);

bool comparesInstances() {
    return INSTANCES;
}

Past loadFirst(ivec2 at) {
    return Past(LOAD_LAYER(framesBefore, at).w);
}

float framesOf(Past past) {
    return past.frames;
}

void loadRest(inout Past there, ivec2 at) {}

void addPast(inout Past sum, Past tap, float weight) {
    sum.frames += weight * tap.frames;
}

Past dividedBy(Past sum, float weight) {
    return Past(sum.frames / weight);
}

bool weighsNormals() {
    return LOBES;
}

float normalScaleOf(uvec2 surface) {
    return lobeNormalScale(roughnessOf(surface), params.lobeScale);
}

#include "denoise/stages/reproject/history.glsl"
#include "denoise/stages/reproject/reflection_motion.glsl"

struct Tap {
    uint reason;   // TAP_*
    float weight;  // 0 if it does not count
};

/// `share`: its bilinear weight.
Tap tapAt(ivec2 at, float share, Expected expected) {
    if (share <= 0.0) return Tap(TAP_UNUSED, 0.0);
    if (at != clamp(at, ivec2(0), ivec2(params.width, params.height) - 1)) return Tap(TAP_OUTSIDE, 0.0);
    const uvec2 surface = LOAD_UINT2(surfacesBefore, at);
    const float depth = distanceOf(surface), cosine = dot(expected.normal, normalOf(surface));
    if (!(depth > 0.0)) return Tap(TAP_NOTHING_SEEN, 0.0);
    uint reason = TAP_FITS;
    if (comparesInstances() && instanceOf(surface) != expected.instance) reason |= TAP_INSTANCE;
    if (!sameNormal(cosine)) reason |= TAP_NORMAL;
    if (!sameDistance(depth, expected)) reason |= TAP_DISTANCE;
    if (!(framesOf(loadFirst(at)) > 0.0)) reason |= TAP_NO_HISTORY;
    if (reason != TAP_FITS) return Tap(reason, 0.0);
    const float weight = weighsNormals() ? share * normalWeight(cosine, expected) : share;
    return weight > 0.0 ? Tap(TAP_FITS, weight) : Tap(TAP_LOBE, 0.0);
}

/// The four taps' reasons, as the first component stores them: at least one is TAP_FITS if they have a history.
uint tapReasons(vec2 position, Expected expected) {
    const vec2 corner = floor(position), share = position - corner;
    const ivec2 first = ivec2(corner);
    const float shares[4] = float[4]((1.0 - share.x) * (1.0 - share.y), share.x * (1.0 - share.y),
                                     (1.0 - share.x) * share.y, share.x * share.y);
    Tap taps[4];
    float weight = 0.0, fitting = 0.0;
    for (int i = 0; i < 4; ++i) {
        taps[i] = tapAt(first + ivec2(i & 1, i >> 1), shares[i], expected);
        weight += taps[i].weight;
        if (taps[i].reason == TAP_FITS) fitting += shares[i];
    }
    uint packed = 0u;
    for (int i = 0; i < 4; ++i) {
        uint reason = taps[i].reason;
        if (reason == TAP_FITS && weight <= MIN_SHARE) reason = fitting > MIN_SHARE ? TAP_LOBE : TAP_LIGHT;
        packed |= reason << (REASON_TAPS + REASON_TAP_BITS * i);
    }
    return packed;
}

bool fitsAny(uint taps) {
    for (int i = 0; i < 4; ++i) {
        if ((taps >> (REASON_TAPS + REASON_TAP_BITS * i) & REASON_TAP_MASK) == TAP_FITS) return true;
    }
    return false;
}

struct Verdict {
    uint reason;  // first component
    float found;  // frames
};

/// What comes of following `moved`.
Verdict verdictOf(ivec2 at, uvec2 surface, vec4 moved) {
    const vec2 size = vec2(params.width, params.height);
    const Reprojection was = reprojectionOf(moved, vec2(at), size);
    const bool known = moved.w > 0.0 && isFinite(vec3(was.position, was.depthChange));
    if (!was.onScreen) return Verdict(known ? REASON_OFF_SCREEN : REASON_NO_MOTION, 0.0);
    const uint taps = tapReasons(was.position, expectedOf(at, surface, was, size));
    const float found = framesOf(pastOf(at, surface, moved));
    if (!(found > 0.0)) return Verdict(taps | REASON_REJECTED, 0.0);
    return Verdict(taps | (fitsAny(taps) ? REASON_KEPT : REASON_SEARCHED), found);
}

/// The frames of a pixel whose reprojection found so many, if nothing shortens them. 0: it has no history.
float wholeHistory(float found) {
    return found > 0.0 ? min(found + 1.0, params.longest) : 0.0;
}

/// `now`: frames of history. A sample that is no number adds no frame to those that were found, which is no work of
/// anti-lag. By rounding to halves alone, histories get shorter by less.
bool wasShortened(float found, float now) {
    const bool added = found < 1.01 || abs(now - found) > 0.005 * found;
    return params.shortens != 0u && added && now < 0.999 * wholeHistory(found) - 0.01;
}

/// `now`: frames of history.
Verdict verdictAt(ivec2 at, float now) {
    const uvec2 surface = LOAD_UINT2(surfaces, at);
    if (!(distanceOf(surface) > 0.0)) return Verdict(REASON_NOTHING_SEEN, 0.0);
    if (params.cut != 0u) return Verdict(REASON_CUT, 0.0);
    Verdict verdict = Verdict(REASON_REJECTED, 0.0);
    if (REFLECTIONS) {
        verdict = verdictOf(at, surface, reflectionMotionAt(at));
        verdict.reason |= REASON_REFLECTED;
    }
    if (!(verdict.found > 0.0)) verdict = verdictOf(at, surface, motionAt(at, surface));
    if (wasShortened(verdict.found, now)) verdict.reason = (verdict.reason & ~REASON_MASK) | REASON_SHORTENED;
    return verdict;
}

/// The colours of temporal_show.comp where they fit.
vec3 rejectedColor(uint reason) {
    uint all = 0u;
    for (int i = 0; i < 4; ++i) {
        const uint tap = reason >> (REASON_TAPS + REASON_TAP_BITS * i) & REASON_TAP_MASK;
        if (tap < TAP_OUTSIDE) all |= tap;
    }
    if ((all & TAP_INSTANCE) != 0u) return vec3(1.0, 0.0, 0.0);
    if ((all & TAP_DISTANCE) != 0u) return vec3(1.0, 0.4, 0.0);
    if ((all & TAP_NORMAL) != 0u) return vec3(0.0, 0.8, 0.0);
    return vec3(0.5, 0.0, 1.0);
}

vec3 colorOf(uint reason, float now) {
    const uint kind = reason & REASON_MASK;
    if (kind == REASON_NOTHING_SEEN) return vec3(0.0, 0.0, 1.0);
    if (kind == REASON_CUT) return vec3(1.0);
    if (kind == REASON_NO_MOTION || kind == REASON_OFF_SCREEN) return vec3(1.0, 1.0, 0.0);
    if (kind == REASON_REJECTED) return rejectedColor(reason);
    const vec3 grey = vec3(0.8 * (1.0 - 1.0 / max(now, 1.0)));
    return kind == REASON_SHORTENED ? grey + vec3(0.0, 0.2, 0.2) : grey;
}

uint roundedFrames(float frames) {
    return uint(clamp(frames + 0.5, 0.0, float(REASON_MAX_FRAMES)));
}

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(params.width) || at.y >= int(params.height)) return;
    const float now = LOAD_LAYER(framesNow, at).w;
    const Verdict verdict = verdictAt(at, now);
    const uint frames = roundedFrames(now) | roundedFrames(wholeHistory(verdict.found)) << REASON_WHOLE;
    imageStore(reasons, at, uvec4(verdict.reason, frames, 0u, 0u));
    imageStore(shown, at, vec4(colorOf(verdict.reason, now), 1.0));
}
