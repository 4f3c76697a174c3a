// The first hit of a camera ray, for the layers.
#ifndef LIMPID_FIRST_HIT_GLSL
#define LIMPID_FIRST_HIT_GLSL

#include "shaders/material/bsdf.glsl"
#include "shaders/common/camera_ray.glsl"
#include "shaders/common/motion.glsl"

/// The maximum number of back faces of single-sided surfaces that a camera ray passes through.
const uint MAX_CULLED = 64u;

const float HIT_NOTHING = 1e9;

struct FirstHit {
    bool hit;
    vec3 position;  // for a miss: the direction
    vec3 normal, albedo, albedoSpecular;
    float depth;
    uvec2 ids;                // instance, material
    PreviousPoint previous;  // the same point in the previous frame
    vec4 reflectionMotion;   // see shaders/common/reflection.glsl; 0: unknown
    float roughness;
    vec2 hitDistance;  // of the reflected ray, HIT_NOTHING for the sky; 1 if it is known
};

FirstHit noHit(vec3 direction) {
    return FirstHit(false, direction, vec3(0.0), vec3(0.0), vec3(0.0), 0.0, uvec2(NONE),
                    PreviousPoint(direction, vec3(0.0)), vec4(0.0), 0.0, vec2(0.0));
}

FirstHit firstHitOf(Surface surface, Bsdf bsdf, float depth, PreviousPoint previous) {
    vec3 albedo = surface.unlit ? vec3(0.0) : surface.baseColor;
    if (HAS_DIFFUSE_TRANSMISSION) albedo = mix(albedo, surface.diffuseTransmissionColor, surface.diffuseTransmission);
    return FirstHit(true, surface.position, surface.normal, albedo,
                    specularAlbedo(bsdf), depth, uvec2(surface.instance, surface.material), previous, vec4(0.0),
                    surface.roughness, vec2(0.0));
}

/// In glTF, the back of a single-sided material is invisible to the camera but still blocks light. Returns
/// true if a camera ray continues behind it from `origin`.
bool passesBack(Surface surface, inout uint culled, inout vec3 origin) {
    const bool passes = surface.culled && ++culled < MAX_CULLED;
    if (passes) origin = offsetRay(surface.position, -surface.geometricNormal, surface.magnitude);
    return passes;
}

/// Returns previous pixel minus this one and previous distance minus this one; w is 1 if there is a previous
/// frame that saw the point.
vec4 motionOf(FirstHit first, ViewParams view) {
    const vec2 size = vec2(view.width, view.height);
    const vec4 now = project(view.camera, size, first.position, !first.hit);
    const vec4 before = project(view.previousCamera, size, first.previous.position, !first.hit);
    if (view.hasPrevious == 0u || now.w * before.w == 0.0) return vec4(0.0);
    return vec4(before.xy - now.xy, first.hit ? before.z - now.z : 0.0, 1.0);
}

#endif
