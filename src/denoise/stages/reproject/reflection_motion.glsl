// How the reflection that a pixel shows has moved. docs/denoising.md, SVGF, step 2.
//
// The including shader declares beforehand `params` with width, height and tests, READ_LAYER `reflectionMotion`, and READ_UINT2
// `surfaces`.
#ifndef LIMPID_REFLECTION_MOTION_GLSL
#define LIMPID_REFLECTION_MOTION_GLSL

#include "denoise/stages/guides.glsl"
#include "denoise/stages/motion.glsl"
#include "denoise/stages/surfaces/surface_texel.glsl"

/// Motion without a change of the distance (xyz / w) gets that of a reflector which stands still. 0 if that was not
/// there.
vec4 withReflectorsChange(ivec2 at, vec4 moved) {
    const MotionEncoding encoding = params.tests.motion;
    const vec2 size = vec2(params.width, params.height), pixel = vec2(at) + encoding.jitter;
    const uvec2 surface = LOAD_UINT2(surfaces, at);
    const vec2 onScreen = pixelOnScreen(pixel, size);
    const float distance = distanceOf(surface);
    const vec3 position = positionOf(params.camera, distance, viewVector(params.camera, onScreen), onScreen);
    const float before = previousReflector(encoding, position, normalOf(surface), pixel + moved.xy / moved.w, size);
    return before > 0.0 ? vec4(moved.xy, moved.w * (before - distance), moved.w) : vec4(0.0);
}

/// The mean over the 3x3 pixels of the same instance: each pixel's value comes from one random ray, or none.
vec4 reflectionMotionAt(ivec2 at) {
    const uint own = instanceOf(LOAD_UINT2(surfaces, at));
    vec4 sum = vec4(0.0);
    for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
            const ivec2 there = at + ivec2(i, j);
            const ivec2 inside = clamp(there, ivec2(0), ivec2(params.width, params.height) - 1);
            const vec4 moved = reflectionOfTexel(params.tests.motion, LOAD_LAYER(reflectionMotion, inside));
            const vec3 motionThere = moved.xyz / max(moved.w, 1e-20);
            const bool valid = moved.w > 0.0 && isFinite(vec3(moved.w)) && isFinite(motionThere);
            if (inside == there && valid && instanceOf(LOAD_UINT2(surfaces, inside)) == own)
                sum += vec4(motionThere, 1.0);
        }
    }
    return sum.w > 0.0 && reflectionsAreFlat(params.tests.motion) ? withReflectorsChange(at, sum) : sum;
}

#endif
