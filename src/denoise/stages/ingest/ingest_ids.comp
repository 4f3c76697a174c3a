#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Converts the caller's object numbers to those that the denoisers read.
#include "denoise/stages/ingest/ingest_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    uvec2 extent;
};
layout(set = 0, binding = 1) uniform utexture2D idIn;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D depth;
layout(set = 0, binding = 3, rg32ui) uniform writeonly uimage2D ids;

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= extent.x || pixel.y >= extent.y) return;
    const ivec2 at = ivec2(pixel);
    const bool seen = imageLoad(depth, at).y > 0.0;
    imageStore(ids, at, seen ? uvec4(texelFetch(idIn, at, 0).r, 0u, 0u, 0u) : uvec4(0xFFFFFFFFu));
}
