#version 460
#extension GL_EXT_scalar_block_layout : require
// ambient_occlusion.glsl with the `compute` tracer.
#include "passes/ambient_occlusion/ambient_occlusion.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
    const uvec2 pixel = pixelOfInvocation(gl_WorkGroupID.xy, gl_LocalInvocationIndex);
    if (pixel.x < params.width && pixel.y < params.height) tracePixel(pixel);
}
