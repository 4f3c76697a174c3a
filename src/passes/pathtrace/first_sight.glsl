// What the layers describe of a path.
#ifndef LIMPID_PATHTRACE_FIRST_SIGHT_GLSL
#define LIMPID_PATHTRACE_FIRST_SIGHT_GLSL

#include "passes/pathtrace/glass.glsl"
#include "shaders/common/lens.glsl"
#include "shaders/common/reflection.glsl"

/// The surface that the layers describe: the camera ray's hit, or what a perfect mirror or smooth glass shows there;
/// and the motion of reflections.
struct FirstSight {
    FirstHit hit;
    float traveled;
    Mirror mirror;     // the camera ray's hit, once it has been scattered
    Lens lens;         // of the glass on the way
    float reflection;  // reflectionShare() if the scattered ray follows a reflection
    bool reflects;     // the ray scattered at the primary vertex is reflected specularly
};

/// `seen` as the mirror, or the glass, before the primary vertex shows it.
FirstHit shownThere(FirstSight sight, Path path, FirstHit seen) {
    if (path.mirrored) return shownBy(sight.mirror, seen, path.throughput);
    return seenThrough(sight.mirror, sight.lens, seen, path.throughput, params.view);
}

void missed(inout FirstSight sight, Path path, uint depth) {
    if (SPLIT_LOBES && depth == path.primary + 1u && sight.reflects) sight.hit.hitDistance = vec2(HIT_NOTHING, 1.0);
    if (depth == 0u) return;
    const FirstHit sky = noHit(path.ray.direction);
    if (depth == path.primary) {
        sight.hit = shownThere(sight, path, sky);
    } else if (depth == 1u && sight.reflection > 0.0) {
        sight.hit.reflectionMotion =
            reflectionMotionOf(sight.mirror, sky, sight.reflection, sight.hit, params.view);
    }
}

void met(inout FirstSight sight, Path path, Hit hit, Surface surface, Bsdf bsdf, uint depth) {
    if (SPLIT_LOBES && depth == path.primary + 1u && sight.reflects) sight.hit.hitDistance = vec2(path.straight + hit.t, 1.0);
    if (depth == path.primary) {
        PreviousPoint previous = PreviousPoint(surface.position, surface.normal);
        if (SPLIT_LOBES) previous = previousPoint(hit, surface, params.scene);
        if (SPLIT_LOBES && HAS_TRANSMISSION && depth > 0u) travel(sight.lens, hit.t);
        sight.hit = firstHitOf(surface, bsdf, sight.traveled, previous);
        if (depth > 0u) sight.hit = shownThere(sight, path, sight.hit);
    } else if (depth == 1u && sight.reflection > 0.0) {
        FirstHit seen = noHit(path.ray.direction);
        seen.hit = true;
        seen.position = surface.position;
        seen.previous = previousPoint(hit, surface, params.scene);
        sight.hit.reflectionMotion =
            reflectionMotionOf(sight.mirror, seen, sight.reflection, sight.hit, params.view);
    }
}

/// Records the scattering at the primary vertex, or at a mirror or glass before it.
void scattered(inout FirstSight sight, inout Path path, Hit hit, Surface surface, Bsdf bsdf, bool seesThrough,
               uint depth) {
    const bool reflected = dot(path.ray.direction, surface.geometricNormal) > 0.0;
    sight.reflects = luminance(path.diffuseShare) < 0.5 && reflected;
    if (!seesThrough && (depth > 0u || !sight.reflects)) return;
    const Shape shape = shapeAt(hit, surface);
    if (depth == 0u) sight.mirror = Mirror(surface.position, surface.normal, sight.hit.previous, shape.curvature);
    if (seesThrough) {
        if (reflected) reflectAt(sight.lens, bsdf.wo.z, shape.curvature);
        else if (bsdf.glassWeight > 0.0) refractAt(sight.lens, bsdf.wo.z, bsdf.eta, shape.curvature);
        path.primary = depth + 1u;
        path.mirrored = depth == 0u && reflected;
    } else if (params.throughMirrors != 0u && path.delta && isPerfectMirror(bsdf)) {
        path.primary = 1u;
        path.mirrored = true;
    } else {
        sight.reflection = reflectionShare(surface, shape);
    }
}

#endif
