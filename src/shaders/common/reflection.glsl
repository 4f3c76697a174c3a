// The motion of a reflection on a glossy surface: it moves like an object behind the surface, not like the
// surface.
#ifndef LIMPID_REFLECTION_GLSL
#define LIMPID_REFLECTION_GLSL

#include "shaders/common/curvature.glsl"
#include "shaders/common/mirror.glsl"
#include "shaders/common/reflection_share.glsl"

/// Minimum cosine between the normals with and without a normal map: on bumps, reflections are elsewhere.
const float SMOOTH = 0.9999;

float reflectionShare(Surface surface, Shape shape) {
    return dot(surface.normal, shape.normal) < SMOOTH ? 0.0 : reflectionShare(surface.roughness);
}

/// `seen` is the reflected ray's hit. Returns the previous pixel at which the reflector showed the same point
/// minus the current one; the distance of the reflector there (approximated by its tangent plane) minus
/// `first.depth`; w is 1 if all of that is known.
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
    // If the ray misses the plane, the plane does not approximate the surface there.
    return distanceBefore > 0.0 ? vec4(motion.xy, distanceBefore - first.depth, 1.0) : vec4(0.0);
}

#endif
