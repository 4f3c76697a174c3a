#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_young.glsl with gpu::Backing::Buffer, for GPUs. Finding young pixels among all would take longer than filling
// them: svgf_variance_buffers.comp has counted them. With one channel there is no such pass.
#define LIMPID_FILTER_BUFFERS
#include "denoise/methods/svgf/shaders/svgf_sharers.glsl"
#include "denoise/methods/svgf/shaders/svgf_young.glsl"

#ifdef LIMPID_ONE_CHANNEL
bool mayHaveYoung() {
    return true;
}
#else
layout(set = 0, binding = 5, r32f) uniform readonly image2D youngTiles;

bool mayHaveYoung() {
    return imageLoad(youngTiles, ivec2(gl_WorkGroupID.xy)).x > 0.0;
}
#endif

shared Sum sums[GROUP * GROUP];

void main() {
    if (!mayHaveYoung()) return;  // most groups
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
