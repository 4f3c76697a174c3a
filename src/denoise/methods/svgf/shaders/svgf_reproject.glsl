// Temporal accumulation of one signal: its color, and the first two moments of its luminance. docs/denoising.md, SVGF,
// steps 2 and 3.
#include "denoise/stages/reprojection.glsl"
#include "denoise/methods/svgf/svgf_params.h"

layout(constant_id = 1) const bool REFLECTIONS = false;  // light is followed as what lies behind its surface
layout(constant_id = 3) const bool STABILISE = false;    // stable light is reprojected, too

layout(set = 0, binding = 0, scalar) uniform Params {
    SvgfReprojectParams params;
};

#include "denoise/methods/svgf/shaders/svgf_signal.glsl"

layout(set = 0, binding = 5, rgba32f) uniform readonly image2D motion;
layout(set = 0, binding = 6, rgba32f) uniform readonly image2D previousNormal;
layout(set = 0, binding = 16, rgba32f) uniform readonly image2D reflectionMotion;
READ_UINT2(7, surfaces);
layout(set = 0, binding = 8, r32ui) uniform readonly uimage2D instances;
READ_UINT2(9, surfacesBefore);
layout(set = 0, binding = 10, r32ui) uniform readonly uimage2D instancesBefore;
READ_HALF4(11, colorBefore);
layout(set = 0, binding = 12, rgba32f) uniform readonly image2D momentsBefore;
WRITE_HALF4(14, color);                                                // light without albedo | deviation, or SVGF_*
layout(set = 0, binding = 15, rgba32f) uniform writeonly image2D moments;  // first, second, fast first, frames
READ_HALF4(18, stableBefore);
WRITE_HALF4(13, stablePast);  // light | weight of this frame's beside it

/// How a surface point must have looked in the previous frame.
struct Expected {
    vec3 normal;
    float depth, tolerance;
    uint instance;
};

struct Past {
    vec3 color, stable;
    vec4 moments;
};

struct Taps {
    Past sum;
    float weight;
};

const Taps NO_TAPS = Taps(Past(vec3(0.0), vec3(0.0), vec4(0.0)), 0.0);

// GPUs wait for all of a tap once, not first for what decides whether it counts; CPUs load as little as they can. (lavapipe of
// Mesa 22.3 found wrong means when everything was loaded at once and the moments last: with images 41 cases of svgf_test
// failed, and passed with the moments loaded before the colors. Why is not known.)
#ifdef LIMPID_FILTER_BUFFERS
const bool WAIT_ONCE = true;
#else
const bool WAIT_ONCE = false;
#endif

void addTap(inout Taps taps, ivec2 at, float weight, Expected expected) {
    const ivec2 inside = clamp(at, ivec2(0), ivec2(params.width, params.height) - 1);
    const uvec2 surface = LOAD_UINT2(surfacesBefore, inside);
    const float depth = uintBitsToFloat(surface.y);
    uint instance = 0u;
    if (WAIT_ONCE) instance = imageLoad(instancesBefore, inside).x;
    Past there = NO_TAPS.sum;
    there.moments = imageLoad(momentsBefore, inside);
    if (WAIT_ONCE) there.color = LOAD_HALF4(colorBefore, inside).rgb;
    if (WAIT_ONCE && STABILISE) there.stable = LOAD_HALF4(stableBefore, inside).rgb;
    const bool counts = at == inside && depth > 0.0 && there.moments.w > 0.0 &&
                        dot(expected.normal, decodeOctahedral(surface.x)) > params.normalTest &&
                        abs(expected.depth - depth) < expected.tolerance &&
                        (WAIT_ONCE ? instance : imageLoad(instancesBefore, inside).x) == expected.instance;
    if (!counts || weight <= 0.0) return;
    if (!WAIT_ONCE) there.color = LOAD_HALF4(colorBefore, inside).rgb;
    if (!WAIT_ONCE && STABILISE) there.stable = LOAD_HALF4(stableBefore, inside).rgb;
    taps.sum.color += weight * there.color;
    taps.sum.stable += weight * there.stable;
    taps.sum.moments += weight * there.moments;
    taps.weight += weight;
}

/// At `position` (pixels, minus one half) of the previous frame; all 0 if nothing fits.
Past pastAt(vec2 position, Expected expected) {
    const vec2 corner = floor(position), share = position - corner;
    const ivec2 first = ivec2(corner), nearest = ivec2(floor(position + 0.5));
    Taps taps = NO_TAPS;
    addTap(taps, first, (1.0 - share.x) * (1.0 - share.y), expected);
    addTap(taps, first + ivec2(1, 0), share.x * (1.0 - share.y), expected);
    addTap(taps, first + ivec2(0, 1), (1.0 - share.x) * share.y, expected);
#ifdef LIMPID_FILTER_BUFFERS
    addTap(taps, first + 1, share.x * share.y, expected);
    if (taps.weight <= MIN_SHARE) {
        taps = NO_TAPS;
        for (int i = 0; params.search != 0u && i < 9; ++i)
            addTap(taps, nearest + ivec2(i % 3, i / 3) - 1, 1.0, expected);
    }
#else
    // The fourth tap and the search in one loop: CPUs run the body of any loop once, but only where a pixel searches
    // more often.
    ivec2 at = first + 1;
    float weight = share.x * share.y;
    int searched = 0;
    bool more;
    do {
        addTap(taps, at, weight, expected);
        const bool failed = taps.weight <= MIN_SHARE;
        more = params.search != 0u && searched < 9 && (failed || searched > 0);
        if (failed && searched == 0) taps = NO_TAPS;
        at = nearest + ivec2(searched % 3, searched / 3) - 1;
        weight = 1.0;
        ++searched;
    } while (more);
#endif
    if (taps.weight <= 0.0) return NO_TAPS.sum;
    return Past(taps.sum.color / taps.weight, taps.sum.stable / taps.weight, taps.sum.moments / taps.weight);
}

/// `moved` as in the `motion` image.
Past pastOf(ivec2 at, uvec2 surface, vec4 moved) {
    const vec2 size = vec2(params.width, params.height);
    const Reprojection was = reprojectionOf(moved, vec2(at), size);
    const float z = uintBitsToFloat(surface.y);
    if (z <= 0.0 || !was.onScreen) return NO_TAPS.sum;
    const float depthBefore = z + was.depthChange;
    const float tolerance = params.relative == 0u ? params.depthTest
                                                  : depthTolerance(params.camera, depthBefore, decodeOctahedral(surface.x),
                                                                   vec2(at), size, params.depthTest);
    return pastAt(was.position,
                  Expected(unitNormal(imageLoad(previousNormal, at)), depthBefore, tolerance, imageLoad(instances, at).x));
}

/// The mean over the 3x3 pixels around that show the same thing: each followed one ray, or none.
vec4 reflectionMotionAt(ivec2 at) {
    const uint own = imageLoad(instances, at).x;
    vec4 sum = vec4(0.0);
    for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
            const ivec2 there = at + ivec2(i, j);
            const ivec2 inside = clamp(there, ivec2(0), ivec2(params.width, params.height) - 1);
            const vec4 moved = imageLoad(reflectionMotion, inside);
            const vec3 motionThere = moved.xyz / max(moved.w, 1e-20);
            const bool valid = moved.w > 0.0 && isFinite(vec3(moved.w)) && isFinite(motionThere);
            if (inside == there && valid && imageLoad(instances, inside).x == own)
                sum += vec4(motionThere, 1.0);
        }
    }
    return sum;
}

Past accumulated(Past past, vec3 x) {
    const float frames = min(past.moments.w + 1.0, params.longest);
    const float l = luminance(x);
    const vec3 alphas = max(vec3(params.alphaMoments, params.alphaMoments, params.alphaFast), 1.0 / frames);
    return Past(mix(past.color, x, max(params.alpha, 1.0 / frames)), past.stable,
                vec4(mix(past.moments.xyz, vec3(l, l * l, l), alphas), frames));
}

/// Of this frame's filtered light, beside the stable light of before.
float stableWeight(float frames) {
    return max(params.stabilisationAlpha, 1.0 / max(frames, 1.0));
}

/// Returns the moments.
vec4 accumulate(ivec2 at) {
    const vec3 light = lightAt(at);
    const vec3 x = demodulated(light, at);
    const uvec2 surface = LOAD_UINT2(surfaces, at);
    Past now = NO_TAPS.sum;
    if (REFLECTIONS) now = pastOf(at, surface, reflectionMotionAt(at));
    if (now.moments.w <= 0.0) now = pastOf(at, surface, imageLoad(motion, at));
    if (isFinite(light)) now = accumulated(now, x);
    const bool seen = uintBitsToFloat(surface.y) > 0.0;
    STORE_HALF4(color, at, seen ? vec4(now.color, deviationOf(now.moments)) : vec4(x, SVGF_NOTHING_SEEN));
    if (STABILISE) STORE_HALF4(stablePast, at, vec4(now.stable, stableWeight(now.moments.w)));
    const vec4 stored = seen ? now.moments : vec4(0.0);
    imageStore(moments, at, stored);
    return stored;
}
