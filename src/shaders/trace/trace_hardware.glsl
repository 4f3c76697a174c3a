// Traces rays through the driver's acceleration structures, from a ray-generation shader. Its trees consist
// of the triangles in bvhTriangles, in that order (gpu/graph/resources.h).
#ifndef LIMPID_TRACE_HARDWARE_GLSL
#define LIMPID_TRACE_HARDWARE_GLSL

#include "shaders/trace/trace_payload.glsl"

layout(set = 0, binding = 63) uniform accelerationStructureEXT topLevel;
layout(location = 0) rayPayloadEXT TracePayload payload;

Hit traceClosest(Ray ray, uint rootNode, uint rng) {
    payload.rng = rng;
    traceRayEXT(topLevel, gl_RayFlagsNoneEXT, 0xffu, 0u, 0u, 0u, ray.origin, 0.0, ray.direction, ray.tMax, 0);
    if (payload.t < 0.0) return Hit(INFINITE_DISTANCE, vec2(0.0), NONE, NONE);
    return Hit(payload.t, payload.barycentrics, payload.triangle, payload.instance);
}

bool traceAny(Ray ray, uint rootNode, uint rng) {
    payload.rng = rng;
    payload.t = 0.0;  // the closest-hit shader is skipped; only a miss changes it
    traceRayEXT(topLevel, gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT, 0xffu, 0u, 0u, 0u,
                ray.origin, 0.0, ray.direction, ray.tMax, 0);
    return payload.t >= 0.0;
}

#endif
