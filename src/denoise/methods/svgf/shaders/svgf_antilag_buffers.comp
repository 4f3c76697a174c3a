#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_antilag.glsl with gpu::Backing::Buffer, for GPUs. Light changes in few places, so a group first looks at its
// tiles and their neighbours; most groups are then done.
#define LIMPID_FILTER_BUFFERS
#include "denoise/methods/svgf/shaders/svgf_antilag.glsl"

const int GROUP = 16;                    // pixels along an edge
const int EDGE = GROUP / SVGF_TILE + 2;  // tiles
layout(local_size_x = 16, local_size_y = 16) in;

shared float lags[EDGE * EDGE];
shared uint anyLags;

void main() {
    const int number = int(gl_LocalInvocationIndex);
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy), firstTile = ivec2(gl_WorkGroupID.xy) * GROUP / SVGF_TILE - 1;
    if (number == 0) anyLags = 0u;
    barrier();
    if (number < EDGE * EDGE) {
        lags[number] = tileAt(firstTile + ivec2(number % EDGE, number / EDGE));
        if (lags[number] >= SVGF_MIN_LAG) atomicOr(anyLags, 1u);
    }
    barrier();
    if (anyLags == 0u || at.x >= int(params.width) || at.y >= int(params.height)) return;
    const Between b = tilesAround(at);
    const ivec2 tile = b.first - firstTile;
    const int corner = tile.y * EDGE + tile.x;
    shorten(at, lagBetween(vec4(lags[corner], lags[corner + 1], lags[corner + EDGE], lags[corner + EDGE + 1]), b.share));
}
