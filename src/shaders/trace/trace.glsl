// The interface through which passes trace rays. Implementations: trace_compute.glsl (our own tree, traversed
// in a compute shader) and, if the including shader defines LIMPID_TRACE_HARDWARE, trace_hardware.glsl (the
// driver's tree, from ray generation). Shading does not depend on which one is used.
#ifndef LIMPID_TRACE_GLSL
#define LIMPID_TRACE_GLSL

#include "shaders/material/material.glsl"

struct Ray {
    vec3 origin;
    vec3 direction;  // unit
    float tMax;
};

const float INFINITE_DISTANCE = 1e30;

struct Hit {
    float t;            // distance; INFINITE_DISTANCE: no hit
    vec2 barycentrics;  // of vertices 1 and 2
    uint triangle;      // in bvhTriangles; its record has instance, primitive and shading triangle
    uint instance;      // for instanced meshes; NONE: the triangle's record has it
};

bool isHit(Hit hit) {
    return hit.t < INFINITE_DISTANCE;
}

// Each implementation has:
//
//     /// Returns the nearest hit with t in (0, ray.tMax). `rng` decides on partly transparent (BLEND) surfaces; its
//     /// state does not change.
//     Hit traceClosest(Ray ray, uint rootNode, uint rng);
//     /// Returns true if there is a hit between the origin and ray.tMax.
//     bool traceAny(Ray ray, uint rootNode, uint rng);
#ifdef LIMPID_TRACE_HARDWARE
#include "shaders/trace/trace_hardware.glsl"
#else
#include "shaders/trace/trace_compute.glsl"
#endif

#endif
