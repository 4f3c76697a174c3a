#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_antilag.glsl with gpu::Backing::Image.
#include "denoise/methods/svgf/shaders/svgf_antilag.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(params.width) || at.y >= int(params.height)) return;
    shorten(at, lagAt(at));
}
