// Primary surface replacement: where the camera sees a perfect mirror, its first hit is replaced by what the
// mirror shows, at its mirrored position. Denoisers then see through mirrors like through windows. Exact for
// plane mirrors; curved ones are approximated by their tangent plane.
#ifndef LIMPID_MIRROR_GLSL
#define LIMPID_MIRROR_GLSL

#include "shaders/common/first_hit.glsl"

struct Mirror {
    vec3 position, normal;  // of the mirror at the camera ray's hit
    PreviousPoint previous;
};

vec3 pointMirroredAt(vec3 p, vec3 onMirror, vec3 normal) {
    return p - 2.0 * dot(p - onMirror, normal) * normal;
}

/// Returns `seen`, the reflected ray's hit, as if seen directly. Its light is multiplied by `tint`.
FirstHit shownBy(Mirror mirror, FirstHit seen, vec3 tint) {
    seen.albedo *= tint;
    seen.albedoSpecular *= tint;
    seen.normal = reflect(seen.normal, mirror.normal);
    seen.previous.normal = reflect(seen.previous.normal, mirror.previous.normal);
    if (seen.hit) {
        seen.position = pointMirroredAt(seen.position, mirror.position, mirror.normal);
        seen.previous.position =
            pointMirroredAt(seen.previous.position, mirror.previous.position, mirror.previous.normal);
    } else {
        seen.position = reflect(seen.position, mirror.normal);
        seen.previous.position = reflect(seen.previous.position, mirror.previous.normal);
    }
    return seen;
}

#endif
