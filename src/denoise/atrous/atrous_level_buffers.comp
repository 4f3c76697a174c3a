#version 460
#extension GL_EXT_scalar_block_layout : require
// atrous_level.glsl with gpu::Backing::Buffer, for GPUs. Registers are what is scarce there: one pixel an invocation.
#define LIMPID_FILTER_BUFFERS
#include "denoise/atrous/atrous_level.glsl"

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(params.width) || at.y >= int(params.height)) return;
    Centre centre = centreOf(loadTap(at));
    if (!centre.seen) {
        store(at, centre);
        return;
    }
    for (int j = -2; j <= 2; ++j) {
        for (int i = -2; i <= 2; ++i) {
            if (i == 0 && j == 0) continue;
            addTo(centre, loadTap(at + params.step * ivec2(i, j)), ivec2(i, j));
        }
    }
    store(at, centre);
}
