#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_young.glsl with gpu::Backing::Image.
#include "denoise/methods/svgf/shaders/svgf_young.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (isYoung(at)) store(at, rowsSum(at, 0, 1));
}
