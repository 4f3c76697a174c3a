#version 460
#extension GL_EXT_scalar_block_layout : require
// A hidden layer: a convolution and ReLU, on cooperative matrices.
#include "denoise/kpcn/shaders/kpcn_matrix.glsl"

layout(set = 0, binding = 3, scalar) writeonly buffer outputTexels { uvec4 texels[]; } outputs;

void main() {
    for (uint tile = 0u; tile < params.outputTiles; tile += TILES) {
        FloatMatrix sums[2][TILES];
        convolve(tile, sums);
        [[unroll]] for (uint m = 0u; m < 2u; ++m) {
            const ivec2 pixel = groupsFirst() + ivec2(0, 2u * gl_SubgroupID + m);
            [[unroll]] for (uint n = 0u; n < TILES; ++n) {
                for (int i = 0; i < sums[m][n].length(); ++i) sums[m][n][i] = clamp(sums[m][n][i], 0.0, 65504.0);
                coopMatStoreNV(HalfMatrix(sums[m][n]), outputs.texels, slabTexel(tile + n, pixel), 2u, false);
            }
        }
    }
}
