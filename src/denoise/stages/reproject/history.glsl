// Reads the history of a pixel's surface point at its position in the previous frame: the mean of those of the four
// bilinear taps that show the same surface. docs/denoising.md, "Temporal accumulation", steps 1 to 4.
//
// The including shader declares beforehand:
//   - `params` with camera, width, height and `ReprojectTests tests`
//   - READ_UINT2 `surfacesBefore`, READ_LAYER `motion` and `previousNormal`. Constant 8 is used here.
//   - struct Past, what its history holds at a pixel, and `const Past NO_PAST`
//   - bool comparesInstances(): whether the instances must be equal
//   - bool weighsNormals(): whether a tap weighs less by exp2(-s (1 - cosine of the normals)); s is
//     float normalScaleOf(uvec2 surface)
//   - Past loadFirst(ivec2 at): a texel with at least what framesOf() needs
//   - float framesOf(Past): 0 if there is no history
//   - void loadRest(inout Past, ivec2 at): what loadFirst() left out
//   - void addPast(inout Past sum, Past tap, float weight), Past dividedBy(Past sum, float weight)
#ifndef LIMPID_HISTORY_GLSL
#define LIMPID_HISTORY_GLSL

#include "denoise/stages/motion.glsl"
#include "denoise/stages/normals.glsl"
#include "denoise/stages/reproject/reprojection.glsl"
#include "denoise/stages/reproject/reproject_params.h"
#include "denoise/stages/surfaces/surface_texel.glsl"

layout(constant_id = 8) const bool TURNS = true;  // else normals were what they are; previousNormal is not read

/// If the accepted taps weigh less than this in total, there is no history: the other taps show another surface.
const float MIN_SHARE = 0.01;

/// How the surface point looked in the previous frame, if it is still the same.
struct Expected {
    vec3 normal;
    float depth, tolerance;
    uint instance;
    float normalScale;
};

bool sameNormal(float cosine) {
    return cosine > params.tests.normal;
}

bool sameDistance(float depth, Expected expected) {
    return abs(expected.depth - depth) < expected.tolerance;
}

/// What a tap's weight is multiplied by.
float normalWeight(float cosine, Expected expected) {
    return exp2(expected.normalScale * (cosine - 1.0));
}

struct Taps {
    Past sum;
    float weight;
};

// On GPUs, all loads of a tap are issued at once, so that their latencies overlap. CPUs load as little as they can,
// and first what decides whether the tap counts. (With images, lavapipe of Mesa 22.3 also computed wrong means if
// everything was loaded at once and the moments last. The cause is unknown.)
#ifdef LIMPID_FILTER_BUFFERS
const bool LOAD_AT_ONCE = true;
#else
const bool LOAD_AT_ONCE = false;
#endif

/// Tolerated difference of distances. Neighbouring pixels of a tilted plane differ in distance; the tolerance leaves
/// room for that.
float depthTolerance(CameraParams camera, float expectedDepth, vec3 n, vec2 pixel, vec2 size, ReprojectTests tests) {
    if (tests.relative == 0u) return tests.depth;
    const vec3 v = viewVector(camera, pixelOnScreen(pixel, size));
    const float cosine = max(abs(dot(n, v)) * inversesqrt(dot(v, v)), 0.05);
    const float tangent = sqrt(max(1.0 - cosine * cosine, 0.0)) / cosine;
    const float spread = camera.spread / (camera.orthographic != 0u ? expectedDepth : 1.0);
    return expectedDepth * (tests.depth + 1.5 * spread * tangent);
}

void addTap(inout Taps taps, ivec2 at, float weight, Expected expected) {
    const ivec2 inside = clamp(at, ivec2(0), ivec2(params.width, params.height) - 1);
    const uvec2 surface = LOAD_UINT2(surfacesBefore, inside);
    const float depth = distanceOf(surface), cosine = dot(expected.normal, normalOf(surface));
    Past there = loadFirst(inside);
    if (LOAD_AT_ONCE) loadRest(there, inside);
    const bool counts = at == inside && depth > 0.0 && framesOf(there) > 0.0 &&
                        sameNormal(cosine) &&
                        sameDistance(depth, expected) &&
                        (!comparesInstances() || instanceOf(surface) == expected.instance);
    if (weighsNormals()) weight *= normalWeight(cosine, expected);
    if (!counts || weight <= 0.0) return;
    if (!LOAD_AT_ONCE) loadRest(there, inside);
    addPast(taps.sum, there, weight);
    taps.weight += weight;
}

/// At `position` (pixels, minus one half) of the previous frame; NO_PAST if no tap fits.
Past pastAt(vec2 position, Expected expected) {
    const vec2 corner = floor(position), share = position - corner;
    const ivec2 first = ivec2(corner), nearest = ivec2(floor(position + 0.5));
    Taps taps = Taps(NO_PAST, 0.0);
    addTap(taps, first, (1.0 - share.x) * (1.0 - share.y), expected);
    addTap(taps, first + ivec2(1, 0), share.x * (1.0 - share.y), expected);
    addTap(taps, first + ivec2(0, 1), (1.0 - share.x) * share.y, expected);
#ifdef LIMPID_FILTER_BUFFERS
    addTap(taps, first + 1, share.x * share.y, expected);
    if (taps.weight <= MIN_SHARE) {
        taps = Taps(NO_PAST, 0.0);
        for (int i = 0; params.tests.search != 0u && i < 9; ++i)
            addTap(taps, nearest + ivec2(i % 3, i / 3) - 1, 1.0, expected);
    }
#else
    // The fourth tap and the search share one loop: lavapipe runs the body of a loop at least once for every pixel,
    // so that a loop of its own would cost a tap even where nothing is searched.
    ivec2 at = first + 1;
    float weight = share.x * share.y;
    int searched = 0;
    bool more;
    do {
        addTap(taps, at, weight, expected);
        const bool failed = taps.weight <= MIN_SHARE;
        more = params.tests.search != 0u && searched < 9 && (failed || searched > 0);
        if (failed && searched == 0) taps = Taps(NO_PAST, 0.0);
        at = nearest + ivec2(searched % 3, searched / 3) - 1;
        weight = 1.0;
        ++searched;
    } while (more);
#endif
    if (taps.weight <= 0.0) return NO_PAST;
    return dividedBy(taps.sum, taps.weight);
}

/// `surface` is the pixel's texel of the `surfaces` image.
Expected expectedOf(ivec2 at, uvec2 surface, Reprojection was, vec2 size) {
    const float depthBefore = distanceOf(surface) + was.depthChange;
    const vec3 normal = normalOf(surface);
    const float tolerance = depthTolerance(params.camera, depthBefore, normal, vec2(at), size, params.tests);
    vec3 normalBefore = normal;
    if (TURNS)
        normalBefore =
            unitNormal(vec4(worldNormal(LOAD_LAYER(previousNormal, at), params.tests.previousNormals), 0.0));
    return Expected(normalBefore, depthBefore, tolerance, instanceOf(surface),
                    weighsNormals() ? normalScaleOf(surface) : 0.0);
}

/// A texel of the layer `motion`, as everywhere below.
vec4 motionAt(ivec2 at, uvec2 surface) {
    return motionOfTexel(params.tests.motion, LOAD_LAYER(motion, at), params.camera, vec2(at),
                         vec2(params.width, params.height), distanceOf(surface));
}

/// `moved` is what motionAt() returns.
Past pastOf(ivec2 at, uvec2 surface, vec4 moved) {
    const vec2 size = vec2(params.width, params.height);
    const Reprojection was = reprojectionOf(moved, vec2(at), size);
    if (distanceOf(surface) <= 0.0 || !was.onScreen) return NO_PAST;
    return pastAt(was.position, expectedOf(at, surface, was, size));
}

#endif
