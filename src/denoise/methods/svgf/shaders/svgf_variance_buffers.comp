#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_variance.glsl with gpu::Backing::Buffer, for GPUs.
#define LIMPID_FILTER_BUFFERS
#include "denoise/methods/svgf/shaders/svgf_sharers.glsl"
#include "denoise/methods/svgf/shaders/svgf_variance.glsl"

layout(set = 0, binding = 4, r32f) uniform writeonly image2D youngTiles;

shared vec3 sums[GROUP * GROUP];

/// svgf_variance.comp shares neighbours between pixels; here most young pixels have none beside them that are young.
void addNeighbour(inout vec3 sum, SurfaceCentre centre, ivec2 at, ivec2 from) {
    const ivec2 there = at + from;
    const ivec2 inside = clamp(there, ivec2(0), ivec2(params.width, params.height) - 1);
    const Surface other = surfaceAt(inside);
    const float weight = from == ivec2(0) ? 1.0 : exp2(surfaceExponent(centre, other, perDepthOf(centre, from)));
    const vec4 m = imageLoad(moments, inside);
    if (inside == there && m.w > 0.0) sum += weight * vec3(momentsBeside(m), 1.0);
}

/// Sums weighted moments and weights over the neighbours in every `step`-th of the 7 rows, from row `first` on.
vec3 rowsSum(ivec2 at, int first, int step) {
    const SurfaceCentre centre = centreOf(surfaceAt(at), at);
    vec3 sum = vec3(0.0);
    for (int j = first - RADIUS; j <= RADIUS; j += step) {
        for (int i = -RADIUS; i <= RADIUS; ++i) addNeighbour(sum, centre, at, ivec2(i, j));
    }
    return sum;
}

void main() {
    const uint count = collectYoung(isYoung(ivec2(gl_GlobalInvocationID.xy)));
    if (gl_LocalInvocationIndex == 0u) imageStore(youngTiles, ivec2(gl_WorkGroupID.xy), vec4(float(count)));
    if (count == 0u) return;
    const Share share = shareOf(count, 2u * uint(RADIUS) + 1u);
    const uint own = gl_LocalInvocationIndex;
    if (share.any) sums[own] = rowsSum(share.at, int(share.part), int(share.sharers));
    barrier();
    if (!share.any || share.part != 0u) return;
    vec3 sum = sums[own];
    for (uint i = 1u; i < share.sharers; ++i) sum += sums[own + i];
    storeDeviation(share.at, sum);
}
