#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_reproject.glsl with gpu::Backing::Buffer, for GPUs. A group of invocations is a tile (svgf_tiles.glsl), so it
// also sums up the tile's moments.
#define LIMPID_FILTER_BUFFERS
#include "denoise/methods/svgf/shaders/svgf_reproject.glsl"
#include "denoise/methods/svgf/shaders/svgf_tiles.glsl"

layout(local_size_x = SVGF_TILE, local_size_y = SVGF_TILE) in;

layout(constant_id = 4) const bool TILES = true;

layout(set = 0, binding = 17, rgba32f) uniform writeonly image2D tileSums;

shared TileSums pixelSums[SVGF_TILE * SVGF_TILE];
shared TileSums rowSums[SVGF_TILE];

/// `own` is the sum of the invocation's own pixel. Every invocation of the group must call this.
void storeTile(TileSums own) {
    const uint number = gl_LocalInvocationIndex;
    pixelSums[number] = own;
    barrier();
    if (number < SVGF_TILE) {
        TileSums row = pixelSums[number * SVGF_TILE];
        for (int i = 1; i < SVGF_TILE; ++i) add(row, pixelSums[number * SVGF_TILE + i]);
        rowSums[number] = row;
    }
    barrier();
    if (number > 0u) return;
    TileSums all = rowSums[0];
    for (int i = 1; i < SVGF_TILE; ++i) add(all, rowSums[i]);
    imageStore(tileSums, ivec2(gl_WorkGroupID.xy), packedSums(all));
}

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    vec4 moments = vec4(0.0);
    if (at.x < int(params.width) && at.y < int(params.height)) moments = accumulate(at);
    if (TILES) storeTile(tileSumsOf(moments, params.lag));
}
