#version 460
#extension GL_EXT_scalar_block_layout : require
// The last layer, fused with the softmax of its channels and the weighted mean of the light, so that the kernels are
// never written to memory.
#include "denoise/kpcn/shaders/kpcn_convolve.glsl"
#include "denoise/kpcn/shaders/kpcn_softmax.glsl"

layout(set = 0, binding = 3, scalar) readonly buffer lightTexels { vec4 texels[]; } light;
layout(set = 0, binding = 4, rgba32f) uniform writeonly image2D clean;
layout(set = 0, binding = 5, scalar) readonly buffer faceTexels { uint texels[]; } faces;

void addTap(inout WeightedMean mean, float logit, uint face, ivec2 pixel, ivec2 tap) {
    const uint at = pixelTexel(params.region, tap);
    if (counts(params, pixel, tap, face, faces.texels[at])) add(mean, logit, light.texels[at]);
}

void main() {
    const ivec2 first = firstPixel();
    if (!inRegion(first)) return;
    WeightedMean means[BLOCK];
    for (int p = 0; p < BLOCK; ++p) means[p] = NO_MEAN;
    for (uint tile = 0u; tile < params.outputTiles; ++tile) {
        vec4 sums[BLOCK][4];
        convolve(first, tile, sums);
        for (int p = 0; p < BLOCK; ++p) {
            const ivec2 pixel = first + ivec2(p, 0);
            if (!inRegion(pixel)) break;
            const uint face = faces.texels[pixelTexel(params.region, pixel)];
            for (uint k = 0u; k < KPCN_SLAB; ++k) {
                ivec2 tap;
                if (kernelTap(params, pixel, tile * KPCN_SLAB + k, tap))
                    addTap(means[p], sums[p][k / 4u][k % 4u], face, pixel, tap);
            }
        }
    }
    for (int p = 0; p < BLOCK; ++p) {
        const ivec2 pixel = first + ivec2(p, 0);
        if (inRegion(pixel)) imageStore(clean, pixel, resultOf(means[p]));
    }
}
