#version 460
#extension GL_EXT_scalar_block_layout : require
// The motion of reflections, from the distance at which the reflected ray hit something: a reflection moves like an
// object behind the surface. docs/embedding.md, "Reflections".
#include "denoise/stages/guides.glsl"
#include "denoise/stages/ingest/ingest_params.h"
#include "denoise/stages/surfaces/surface_texel.glsl"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    IngestParams params;
};
READ_LAYER(1, roughnessIn);
READ_LAYER(2, hitDistanceIn);
READ_UINT2(3, surfaces);
READ_LAYER(4, motionIn);
layout(set = 0, binding = 5, rgba16f) uniform writeonly image2D reflectionMotion;

#include "denoise/stages/motion.glsl"
#include "shaders/common/reflection_share.glsl"

const int BASELINE = 3;             // pixels to each side over which the curvature is measured
const float SAME_SURFACE = 0.8;     // minimum cosine between the normals at its ends and the pixel's
const float NORMAL_ROUNDING = 4e-3;  // change of a normal that may be its encoding's error
const float STILL = 0.5;            // pixels: a surface that moves further by itself is not followed
const float FARTHEST = 1e9;         // hits beyond are the sky

struct Point {
    vec3 position, normal;
    bool seen;
};

vec2 onScreenAt(ivec2 at) {
    return pixelOnScreen(vec2(at) + params.motion.jitter, vec2(params.width, params.height));
}

Point pointAt(ivec2 at) {
    const ivec2 inside = clamp(at, ivec2(0), ivec2(params.width, params.height) - 1);
    const uvec2 surface = LOAD_UINT2(surfaces, inside);
    const float z = distanceOf(surface);
    const vec2 onScreen = onScreenAt(inside);
    return Point(positionOf(params.camera, z, viewVector(params.camera, onScreen), onScreen), normalOf(surface),
                 z > 0.0 && at == inside);
}

/// The surface's curvature along one axis of the screen, 1 / radius; positive if it is convex. False if the pixels
/// around show another surface.
bool curvatureAlong(ivec2 at, ivec2 axis, Point own, out float curvature) {
    const Point a = pointAt(at - BASELINE * axis), b = pointAt(at + BASELINE * axis);
    const vec3 along = b.position - a.position, turn = b.normal - a.normal;
    const float size = length(turn);
    curvature = dot(turn, along) / max(dot(along, along), 1e-30) * max(1.0 - NORMAL_ROUNDING / max(size, 1e-30), 0.0);
    return a.seen && b.seen && dot(a.normal, own.normal) > SAME_SURFACE && dot(b.normal, own.normal) > SAME_SURFACE;
}

/// Where the reflected point appears to be: w 0 if it is a direction. A curved mirror's image is nearer to it than a
/// flat one's, by the mirror equation 1 / image = 1 / distance + 2 / radius (its use here: A. Hirvonen et al.,
/// "Accurate Real-Time Specular Reflections with Radiance Caching", Ray Tracing Gems, 2019). Returns false for images
/// before the mirror.
bool imageOf(Point own, vec3 view, float hit, float curvature, float share, out vec4 image) {
    const float inverse = (hit < FARTHEST ? 1.0 / hit : 0.0) + 2.0 * curvature;
    image = inverse > 1.0 / FARTHEST ? vec4(own.position + view * (share / inverse), 1.0) : vec4(view, 0.0);
    return inverse >= 0.0;
}

vec4 reflectionMotionAt(ivec2 at) {
    const Point own = pointAt(at);
    const float hit = LOAD_LAYER(hitDistanceIn, at).r, share = reflectionShare(LOAD_LAYER(roughnessIn, at).r);
    if (!own.seen || !(hit > 0.0) || !(share > 0.0)) return vec4(0.0);
    float curvatureX, curvatureY;
    const bool knowsX = curvatureAlong(at, ivec2(1, 0), own, curvatureX);
    const bool knowsY = curvatureAlong(at, ivec2(0, 1), own, curvatureY);
    if (!knowsX && !knowsY) return vec4(0.0);
    const float curvature = ((knowsX ? curvatureX : curvatureY) + (knowsY ? curvatureY : curvatureX)) / 2.0;
    vec4 image;
    const vec3 view = normalize(viewVector(params.camera, onScreenAt(at)));
    if (!imageOf(own, view, hit, curvature, share, image)) return vec4(0.0);
    const vec2 size = vec2(params.width, params.height);
    const float distance = distanceOf(LOAD_UINT2(surfaces, at));
    const vec4 ownMotion =
        motionOfTexel(params.motion, LOAD_LAYER(motionIn, at), params.camera, vec2(at), size, distance);
    const vec4 still = motionOfStill(params.motion, vec4(own.position, 1.0), vec2(at), size);
    const vec4 moved = motionOfStill(params.motion, image, vec2(at), size);
    if (moved.w == 0.0 || still.w == 0.0 || length(ownMotion.xy - still.xy) > STILL) return vec4(0.0);
    const float before = previousReflector(params.motion, own.position, own.normal,
                                           vec2(at) + params.motion.jitter + moved.xy, size);
    return before > 0.0 ? vec4(moved.xy, before - distance, 1.0) : vec4(0.0);
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    const vec4 moved = params.motion.hasPrevious != 0u ? reflectionMotionAt(at) : vec4(0.0);
    const vec4 stored = nearestHalf(clamp(moved, -MAX_HALF, MAX_HALF));
    imageStore(reflectionMotion, at, isFinite(moved.xyz) ? stored : vec4(0.0));
}
