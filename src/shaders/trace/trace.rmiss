#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_scalar_block_layout : require
// Reports a miss.
#include "shaders/trace/trace_payload.glsl"

layout(location = 0) rayPayloadInEXT TracePayload payload;

void main() {
    payload.t = -1.0;
}
