#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_young.glsl with gpu::Backing::Buffer, for GPUs.
#define LIMPID_FILTER_BUFFERS
#include "denoise/methods/svgf/shaders/svgf_sharers.glsl"
#include "denoise/methods/svgf/shaders/svgf_young.glsl"

shared Sum sums[GROUP * GROUP];

void main() {
    const uint count = collectYoung(isYoung(ivec2(gl_GlobalInvocationID.xy)));
    if (count == 0u) return;
    const Share share = shareOf(count, 2u * uint(params.youngRadius) + 1u);
    const uint own = gl_LocalInvocationIndex;
    if (share.any) sums[own] = rowsSum(share.at, int(share.part), int(share.sharers));
    barrier();
    if (!share.any || share.part != 0u) return;
    Sum sum = sums[own];
    for (uint i = 1u; i < share.sharers; ++i) {
        sum.light += sums[own + i].light;
        sum.squares += sums[own + i].squares;
    }
    store(share.at, sum);
}
