// How a reflection moves over a glossy surface: as what lies behind the surface, not as the surface.
#ifndef LIMPID_REFLECTION_GLSL
#define LIMPID_REFLECTION_GLSL

#include "shaders/common/mirror.glsl"

/// Light that rougher surfaces reflect moves with them.
const float MAX_REFLECTING_ROUGHNESS = 0.3;
/// Cosine between shading and true normal: what is rounder has its reflections elsewhere.
const float FLAT = 0.9999;

/// How far behind the surface its reflections lie, as a share of where a mirror's would: the lobe's dominant direction leans
/// from the mirrored one to the normal by as much (S. Lagarde and C. de Rousiers, "Moving Frostbite to Physically Based
/// Rendering", 2014, section 4.9).
float reflectionShare(Surface surface) {
    if (surface.roughness >= MAX_REFLECTING_ROUGHNESS || abs(dot(surface.normal, surface.geometricNormal)) < FLAT) return 0.0;
    const float smoothness = 1.0 - surface.roughness;
    return smoothness * (sqrt(smoothness) + surface.roughness);
}

/// `seen` by the reflected ray. Previous pixel where the reflector showed the same minus the one where it does now;
/// distance of the reflector there, which is taken for its tangent plane, minus `first.depth`; 1 in w if all of that is known.
vec4 reflectionMotionOf(Mirror reflector, FirstHit seen, float share, FirstHit first, ViewParams view) {
    FirstHit shown = shownBy(reflector, seen, vec3(1.0));
    if (seen.hit) {
        shown.position = mix(reflector.position, shown.position, share);
        shown.previous.position = mix(reflector.previous.position, shown.previous.position, share);
    }
    const vec4 motion = motionOf(shown, view);
    if (motion.w == 0.0) return vec4(0.0);
    const vec2 size = vec2(view.width, view.height);
    const vec2 before = project(view.camera, size, first.position, false).xy + motion.xy;
    const Ray ray = cameraRay(view.previousCamera, size, before);
    const PreviousPoint plane = reflector.previous;
    const float distanceBefore = dot(plane.position - ray.origin, plane.normal) / dot(ray.direction, plane.normal);
    // Where the ray does not meet the plane it is no tangent of what was there.
    return distanceBefore > 0.0 ? vec4(motion.xy, distanceBefore - first.depth, 1.0) : vec4(0.0);
}

#endif
