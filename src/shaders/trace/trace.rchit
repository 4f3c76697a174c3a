#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_scalar_block_layout : require
// Reports the nearest hit; ray generation shades it.
#include "shaders/trace/trace_payload.glsl"
#include "shaders/trace/trace_hit.glsl"

layout(location = 0) rayPayloadInEXT TracePayload payload;
hitAttributeEXT vec2 barycentrics;

void main() {
    const uvec2 placement = placementOfHit();
    payload.t = gl_HitTEXT;
    payload.barycentrics = barycentrics;
    payload.instance = placement.x;
    payload.triangle = placement.y + uint(gl_PrimitiveID);
}
