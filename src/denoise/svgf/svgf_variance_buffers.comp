#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_variance.glsl with gpu::Backing::Buffer, for GPUs. Young pixels are few and scattered: a group collects its own, and
// shares out their rows, so that few of its subgroups have work, and those are full and soon done.
#define LIMPID_FILTER_BUFFERS
#include "denoise/svgf/svgf_variance.glsl"

const uint GROUP = 16;
layout(local_size_x = 16, local_size_y = 16) in;

const uint SHARE = 8;  // invocations for a pixel, the last of which has no row
const uint AT_ONCE = GROUP * GROUP / SHARE;

shared uint count;
shared uint young[GROUP * GROUP];
shared vec3 rows[GROUP * GROUP];

ivec2 youngAt(uint number) {
    return ivec2(gl_WorkGroupID.xy * GROUP + uvec2(young[number] % GROUP, young[number] / GROUP));
}

void main() {
    const uint own = gl_LocalInvocationIndex;
    if (own == 0u) count = 0u;
    barrier();
    if (isYoung(ivec2(gl_GlobalInvocationID.xy))) young[atomicAdd(count, 1u)] = own;
    barrier();
    const int row = int(own % SHARE);
    for (uint first = 0u; first < count; first += AT_ONCE) {
        const uint number = first + own / SHARE;
        const bool has = number < count && row <= 2 * RADIUS;
        rows[own] = has ? rowSum(youngAt(number), row - RADIUS) : vec3(0.0);
        barrier();
        if (has && row == 0) {
            vec3 sum = vec3(0.0);
            for (uint i = 0u; i <= 2u * RADIUS; ++i) sum += rows[own + i];
            storeDeviation(youngAt(number), sum);
        }
        barrier();
    }
}
