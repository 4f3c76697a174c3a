#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_variance.glsl with gpu::Backing::Buffer, for GPUs. Young pixels are few and scattered: a group collects its own, so
// that few of its subgroups have work, and those are full.
#define LIMPID_FILTER_BUFFERS
#include "denoise/svgf/svgf_variance.glsl"

const uint GROUP = 16;
layout(local_size_x = 16, local_size_y = 16) in;

shared uint count;
shared uint young[GROUP * GROUP];

void main() {
    if (gl_LocalInvocationIndex == 0u) count = 0u;
    barrier();
    if (isYoung(ivec2(gl_GlobalInvocationID.xy))) young[atomicAdd(count, 1u)] = gl_LocalInvocationIndex;
    barrier();
    if (gl_LocalInvocationIndex >= count) return;
    const uint own = young[gl_LocalInvocationIndex];
    estimate(ivec2(gl_WorkGroupID.xy * GROUP + uvec2(own % GROUP, own / GROUP)));
}
