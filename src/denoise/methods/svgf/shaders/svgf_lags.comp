#version 460
#extension GL_EXT_scalar_block_layout : require
// The lag of each tile: from its own sums or from those of the 3x3 tiles around it, whichever is larger.
// docs/denoising.md, SVGF, step 4.
#include "denoise/methods/svgf/shaders/svgf_tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool AROUND = true;  // look at the 3x3 tiles, too

layout(set = 0, binding = 0, scalar) uniform Params {
    SvgfTilesParams params;
};
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D tileSums;
layout(set = 0, binding = 2, r32f) uniform writeonly image2D tiles;

void main() {
    const ivec2 tile = ivec2(gl_GlobalInvocationID.xy), size = ivec2(params.columns, params.rows);
    if (any(greaterThanEqual(tile, size))) return;
    const TileSums own = unpackedSums(imageLoad(tileSums, tile));
    float lag = lagOf(own, params.lag);
    if (AROUND) {
        TileSums around = own;
        for (int j = -1; j <= 1; ++j) {
            for (int i = -1; i <= 1; ++i) {
                const ivec2 there = tile + ivec2(i, j), inside = clamp(there, ivec2(0), size - 1);
                if (there != tile && there == inside) add(around, unpackedSums(imageLoad(tileSums, inside)));
            }
        }
        lag = max(lag, lagOf(around, params.lag));
    }
    imageStore(tiles, tile, vec4(lag));
}
