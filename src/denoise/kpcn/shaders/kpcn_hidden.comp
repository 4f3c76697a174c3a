#version 460
#extension GL_EXT_scalar_block_layout : require
// A hidden layer: a convolution and ReLU.
#include "denoise/kpcn/shaders/kpcn_convolve.glsl"

layout(set = 0, binding = 3, scalar) writeonly buffer outputTexels { KPCN_TEXEL texels[]; } outputs;

void main() {
    const ivec2 first = firstPixel();
    if (!inRegion(first)) return;
    for (uint tile = 0u; tile < params.outputTiles; ++tile) {
        vec4 sums[BLOCK][4];
        convolve(first, tile, sums);
        for (int p = 0; p < BLOCK; ++p) {
            const ivec2 pixel = first + ivec2(p, 0);
            if (!inRegion(pixel)) break;
            const uint at = channelTexel(params.region, tile, pixel);
            for (int o = 0; o < 4; ++o) outputs.texels[at + uint(o)] = toTexel(max(sums[p][o], vec4(0.0)));
        }
    }
}
