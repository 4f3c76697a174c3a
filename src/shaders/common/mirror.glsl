// Primary surface replacement: where the camera sees a perfect mirror, its first hit is replaced by what the
// mirror shows, at its mirrored position. Denoisers then see through mirrors like through windows. Exact for
// plane mirrors. A curved mirror's image is nearer or farther by the mirror equation, as for a mirror seen from the front
// (A. Hirvonen et al., "Accurate Real-Time Specular Reflections with Radiance Caching", Ray Tracing Gems, 2019).
#ifndef LIMPID_MIRROR_GLSL
#define LIMPID_MIRROR_GLSL

#include "shaders/common/first_hit.glsl"

struct Mirror {
    vec3 position, normal;  // of the mirror at the camera ray's hit
    PreviousPoint previous;
    float curvature;  // 1 / radius, positive if convex
};

vec3 pointMirroredAt(vec3 p, vec3 onMirror, vec3 normal) {
    return p - 2.0 * dot(p - onMirror, normal) * normal;
}

/// The image's distance behind the mirror, relative to that behind a flat one: 1 / image = 1 / distance + 2 / radius. An
/// image before the mirror, or beyond infinity, is not followed: it counts as that of a flat one.
float imageShare(Mirror mirror, vec3 seen) {
    const float inverse = 1.0 + 2.0 * mirror.curvature * distance(seen, mirror.position);
    return inverse > 0.0 ? 1.0 / inverse : 1.0;
}

/// Returns `seen`, the reflected ray's hit, as if seen directly. Its light is multiplied by `tint`.
FirstHit shownBy(Mirror mirror, FirstHit seen, vec3 tint) {
    seen.albedo *= tint;
    seen.albedoSpecular *= tint;
    seen.normal = reflect(seen.normal, mirror.normal);
    seen.previous.normal = reflect(seen.previous.normal, mirror.previous.normal);
    if (seen.hit) {
        const float share = imageShare(mirror, seen.position);
        seen.position =
            mix(mirror.position, pointMirroredAt(seen.position, mirror.position, mirror.normal), share);
        seen.previous.position =
            mix(mirror.previous.position,
                pointMirroredAt(seen.previous.position, mirror.previous.position, mirror.previous.normal), share);
    } else {
        seen.position = reflect(seen.position, mirror.normal);
        seen.previous.position = reflect(seen.previous.position, mirror.previous.normal);
    }
    return seen;
}

#endif
