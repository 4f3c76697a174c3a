#version 460
#extension GL_EXT_scalar_block_layout : require
// light_first_hits.glsl with the `compute` tracer.
#include "passes/light_distances/light_first_hits.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
    const uvec2 place = pixelOfInvocation(gl_WorkGroupID.xy, gl_LocalInvocationIndex);
    if (place.y < params.maps * LIGHT_MAP_SIZE) traceTexel(place);
}
