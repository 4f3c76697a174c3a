#version 460
#extension GL_EXT_scalar_block_layout : require
// A debug view: the picture in grey, with a colour where a pixel has no history. The colour shows why.
#include "denoise/methods/temporal/temporal_params.h"
#include "shaders/common/sampling.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    TemporalShowParams params;
};
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D beauty;
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D disocclusion;
layout(set = 0, binding = 3, rgba32f) uniform writeonly image2D shown;

vec3 colorOf(uint failure, vec3 tracked) {
    const vec3 colors[4] = vec3[4](tracked, vec3(0.0, 0.0, 1.0), vec3(1.0, 1.0, 0.0), vec3(1.0, 0.0, 0.0));
    return colors[failure & DISOCCLUSION_MASK];
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    const vec3 grey = vec3(luminance(imageLoad(beauty, at).rgb));
    imageStore(shown, at, vec4(colorOf(imageLoad(disocclusion, at).x, grey), 1.0));
}
