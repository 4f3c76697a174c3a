#version 460
#extension GL_EXT_scalar_block_layout : require
#include "trace_test.glsl"

layout(local_size_x = 64) in;

void main() {
    if (gl_GlobalInvocationID.x < params.count) traceRayNumber(gl_GlobalInvocationID.x);
}
