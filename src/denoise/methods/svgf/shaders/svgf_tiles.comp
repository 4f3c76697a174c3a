#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_tiles.glsl for CPUs, on which barriers within a group cost more than another pass. GPUs do the same in
// svgf_reproject_buffers.comp.
#include "denoise/methods/svgf/shaders/svgf_tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    SvgfTileSumsParams params;
};
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D moments;
layout(set = 0, binding = 2, rgba32f) uniform writeonly image2D tileSums;

void main() {
    const ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 first = tile * SVGF_TILE, size = ivec2(params.width, params.height);
    if (any(greaterThanEqual(first, size))) return;
    TileSums sums = TileSums(0.0, 0.0, 0.0);
    for (int j = 0; j < SVGF_TILE; ++j) {
        for (int i = 0; i < SVGF_TILE; ++i) {
            const ivec2 at = first + ivec2(i, j);
            const vec4 m = unpackedMoments(imageLoad(moments, min(at, size - 1)));
            const vec4 inside = all(lessThan(at, size)) ? m : vec4(0.0);
            add(sums, tileSumsOf(inside, params.lag));
        }
    }
    imageStore(tileSums, tile, packedSums(sums));
}
