#version 460
#extension GL_EXT_scalar_block_layout : require
// Writes the distance of each pixel, 0 where nothing is hit. kpcn_largest.comp finds the largest of them.
#include "denoise/stages/guides.glsl"
#include "denoise/kpcn/kpcn_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    KpcnReduceParams params;
};
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D depth;
layout(set = 0, binding = 2, r32f) uniform writeonly image2D distances;

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= params.width || at.y >= params.height) return;
    imageStore(distances, at, vec4(hitDistance(imageLoad(depth, at))));
}
