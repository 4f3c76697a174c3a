#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_variance.glsl with gpu::Backing::Buffer, for GPUs. Young pixels are either few and scattered, or many in one
// place. So a group collects its young pixels and distributes the rows of their taps over all of its invocations.
#define LIMPID_FILTER_BUFFERS
#include "denoise/methods/svgf/shaders/svgf_variance.glsl"

const uint GROUP = 16;
layout(local_size_x = 16, local_size_y = 16) in;

shared uint count;
shared uint young[GROUP * GROUP];
shared vec3 sums[GROUP * GROUP];

ivec2 youngAt(uint number) {
    return ivec2(gl_WorkGroupID.xy * GROUP + uvec2(young[number] % GROUP, young[number] / GROUP));
}

/// svgf_variance.comp shares neighbours between pixels; here most young pixels have none beside them that are young.
void addNeighbour(inout vec3 sum, SurfaceCentre centre, ivec2 at, ivec2 from) {
    const ivec2 there = at + from;
    const ivec2 inside = clamp(there, ivec2(0), ivec2(params.width, params.height) - 1);
    const Surface other = surfaceAt(inside);
    const float weight = from == ivec2(0) ? 1.0 : exp2(surfaceExponent(centre, other, perDepthOf(centre, from)));
    const vec4 m = unpackedMoments(imageLoad(moments, inside));
    if (inside == there && m.w > 0.0) sum += weight * vec3(m.xy, 1.0);
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

/// The number of invocations per young pixel; more than there are rows would be idle. There must be a young pixel.
uint sharers() {
    return min(GROUP * GROUP / count, 2u * uint(RADIUS) + 1u);
}

void main() {
    const uint own = gl_LocalInvocationIndex;
    if (own == 0u) count = 0u;
    barrier();
    if (isYoung(ivec2(gl_GlobalInvocationID.xy))) young[atomicAdd(count, 1u)] = own;
    barrier();
    if (count == 0u) return;
    const uint share = sharers(), number = own / share, part = own % share;
    const bool has = number < count;
    if (has) sums[own] = rowsSum(youngAt(number), int(part), int(share));
    barrier();
    if (!has || part != 0u) return;
    vec3 sum = sums[own];
    for (uint i = 1u; i < share; ++i) sum += sums[own + i];
    storeDeviation(youngAt(number), sum);
}
