// Absorption along a path: what a surface says of the bodies on its two sides. All are per unit of length.
#ifndef LIMPID_MEDIUM_GLSL
#define LIMPID_MEDIUM_GLSL

#include "shaders/material/material.glsl"

/// On the viewer's side of a surface, for a path that comes through `medium`. The surface knows it where it is met from
/// within, and for bodies in bodies better than the path: that forgets the outer one.
vec3 mediumBefore(vec3 medium, Surface surface) {
    return isBoundary(surface) && !surface.front ? surface.absorption : medium;
}

/// Where `direction` leads to from the surface.
vec3 mediumTowards(vec3 medium, Surface surface, vec3 direction) {
    const bool crosses = dot(direction, surface.geometricNormal) < 0.0 && isBoundary(surface);
    if (!crosses) return mediumBefore(medium, surface);
    return surface.front ? surface.absorption : vec3(0.0);
}

#endif
