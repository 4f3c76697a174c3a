// Absorption along a path, from the media on both sides of a surface. All values are per unit of length.
#ifndef LIMPID_MEDIUM_GLSL
#define LIMPID_MEDIUM_GLSL

#include "shaders/material/material.glsl"

/// Returns the medium on the viewer's side of a surface, for a path that comes through `medium`. If a body is
/// hit from within, its surface knows the medium; for nested bodies it knows better than the path, which
/// forgets the outer one.
vec3 mediumBefore(vec3 medium, Surface surface) {
    return isBoundary(surface) && !surface.front ? surface.absorption : medium;
}

/// Returns the medium that `direction` leads into.
vec3 mediumTowards(vec3 medium, Surface surface, vec3 direction) {
    const bool crosses = dot(direction, surface.geometricNormal) < 0.0 && isBoundary(surface);
    if (!crosses) return mediumBefore(medium, surface);
    return surface.front ? surface.absorption : vec3(0.0);
}

#endif
