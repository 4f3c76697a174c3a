#version 460
#extension GL_EXT_scalar_block_layout : require
// Like kpcn_kernel.comp, on cooperative matrices: the last layer, fused with the softmax of its channels and the
// weighted mean of the light.
#include "denoise/kpcn/shaders/kpcn_matrix.glsl"
#include "denoise/kpcn/shaders/kpcn_storage.glsl"
#include "denoise/kpcn/shaders/kpcn_softmax.glsl"

layout(set = 0, binding = 3, scalar) readonly buffer lightTexels { vec4 texels[]; } light;
layout(set = 0, binding = 4, rgba32f) uniform writeonly image2D clean;
layout(set = 0, binding = 5, scalar) readonly buffer faceTexels { uint texels[]; } faces;

const uint LOGITS_PITCH = 2u * TILES + 1u;  // uvec4 per pixel; 256 pixels fit in `stage` if TILES <= 4

void main() {
    const ivec2 pixel = groupsFirst() + ivec2(gl_LocalInvocationID.xy);
    const bool inRegion = pixel.x < params.region.left + params.region.width && pixel.y < params.region.top + params.region.height;
    const uint face = inRegion ? faces.texels[pixelTexel(params.region, pixel)] : 0u;
    WeightedMean mean = NO_MEAN;
    for (uint tile = 0u; tile < params.outputTiles; tile += TILES) {
        FloatMatrix sums[2][TILES];
        convolve(tile, sums);
        barrier();
        [[unroll]] for (uint m = 0u; m < 2u; ++m) {
            [[unroll]] for (uint n = 0u; n < TILES; ++n)
                coopMatStoreNV(HalfMatrix(sums[m][n]), stage, (2u * gl_SubgroupID + m) * EDGE * LOGITS_PITCH + 2u * n, LOGITS_PITCH, false);
        }
        barrier();
        for (uint i = 0u; i < 2u * TILES && inRegion; ++i) {
            const uvec4 eight = stage[gl_LocalInvocationIndex * LOGITS_PITCH + i];
            for (uint k = 0u; k < 8u; ++k) {
                const vec2 pair = unpackHalf2x16(eight[k / 2u]);
                ivec2 tap;
                if (!kernelTap(params, pixel, tile * KPCN_SLAB + i * 8u + k, tap)) continue;
                const uint at = pixelTexel(params.region, tap);
                const float logit = clamp(pair[k % 2u], -MAX_HALF, MAX_HALF);  // infinity would give NaN
                if (counts(params, pixel, tap, face, faces.texels[at])) add(mean, logit, light.texels[at]);
            }
        }
    }
    if (inRegion) imageStore(clean, pixel, resultOf(mean));
}
