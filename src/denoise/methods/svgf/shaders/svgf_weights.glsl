// The edge-stopping functions of normals, depth and roughness: how far two pixels show the same surface.
// docs/denoising.md, SVGF, step 6. The including shader declares `SvgfFilterParams params` and READ_UINT2 `surfaces`
// beforehand.
#ifndef LIMPID_SVGF_WEIGHTS_GLSL
#define LIMPID_SVGF_WEIGHTS_GLSL

#include "denoise/stages/guides.glsl"
#include "denoise/stages/surfaces/surface_texel.glsl"

layout(constant_id = 1) const bool POSITION = false;  // compare distances of points instead of depths and slopes
layout(constant_id = 2) const bool ORTHOGRAPHIC = false;
layout(constant_id = 7) const bool ROUGHNESS = false;  // compare roughness, too

struct Surface {
    vec3 normal;
    float depth;      // 0: nothing seen
    vec3 point;       // relative to the eye; only with POSITION
    float roughness;  // roughnessStepsOf(); only with ROUGHNESS
};

/// A pixel that others are compared with. Values are scaled so that weights are powers of 2.
struct SurfaceCentre {
    Surface surface;
    vec3 scaledNormal;
    vec2 slope;  // change of the depth from tap to tap, to the right and down
    float floor;
};

vec3 rayOf(ivec2 at) {
    return viewVector(params.camera, pixelOnScreen(vec2(at), vec2(params.width, params.height)));
}

vec3 pointOf(ivec2 at, float depth) {
    const vec3 ray = rayOf(at);
    if (!ORTHOGRAPHIC) return ray * (depth * inversesqrt(dot(ray, ray)));
    const vec2 onScreen = pixelOnScreen(vec2(at), vec2(params.width, params.height));
    return onScreen.x * params.camera.right + onScreen.y * params.camera.up + depth * params.camera.forward;
}

Surface surfaceAt(ivec2 at) {
    const uvec2 packed = LOAD_UINT2(surfaces, at);
    const float depth = distanceOf(packed);
    return Surface(normalOf(packed), depth, POSITION ? pointOf(at, depth) : vec3(0.0),
                   ROUGHNESS ? roughnessStepsOf(packed) : 0.0);
}

vec2 slopeOf(Surface surface, ivec2 at) {
    const vec3 ray = rayOf(at);
    const vec3 toRight = params.camera.right * (2.0 / float(params.width));
    const vec3 down = params.camera.up * (-2.0 / float(params.height));
    const float squared = dot(ray, ray);
    float facing = dot(surface.normal, ray);
    const float minimum = SVGF_MIN_SLOPE * sqrt(squared);
    facing = facing < 0.0 ? min(facing, -minimum) : max(facing, minimum);
    const vec2 tilt = vec2(dot(surface.normal, toRight), dot(surface.normal, down)) / facing;
    if (ORTHOGRAPHIC) return -tilt;
    return surface.depth * (vec2(dot(ray, toRight), dot(ray, down)) / squared - tilt);
}

SurfaceCentre centreOf(Surface surface, ivec2 at) {
    SurfaceCentre centre;
    centre.surface = surface;
    centre.scaledNormal = surface.normal * params.normalScale;
    centre.slope = slopeOf(surface, at) * (float(params.step) / params.depthScale);
    centre.floor = SVGF_DEPTH_FLOOR * surface.depth / params.depthScale;
    return centre;
}

/// The factor for a difference of depths; equal for opposite taps. `from` is the other tap's offset in taps.
float perDepthOf(SurfaceCentre centre, ivec2 from) {
    return POSITION ? 0.0 : 1.0 / (abs(dot(vec2(from), centre.slope)) + centre.floor);
}

/// The exponent to base 2 of the weight by normals and depths.
float geometryExponent(SurfaceCentre centre, Surface other, float perDepth) {
    if (POSITION)
        return -distance(centre.surface.normal, other.normal) * params.normalScale -
               distance(centre.surface.point, other.point) * params.depthScale;
    return dot(centre.scaledNormal, other.normal) - params.normalScale -
           abs(centre.surface.depth - other.depth) * perDepth;
}

/// That of the weight by roughness.
float roughnessExponent(Surface centre, Surface other) {
    return ROUGHNESS && !POSITION ? -abs(centre.roughness - other.roughness) * params.roughnessScale : 0.0;
}

/// That of the product of all weights.
float surfaceExponent(SurfaceCentre centre, Surface other, float perDepth) {
    return geometryExponent(centre, other, perDepth) + roughnessExponent(centre.surface, other);
}

#endif
