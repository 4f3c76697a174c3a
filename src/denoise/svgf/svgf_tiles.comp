#version 460
#extension GL_EXT_scalar_block_layout : require
// What 8x8 pixels together say of one signal: how far the slow mean of the luminance lags behind the fast one.
// docs/denoising.md, SVGF, step 4.
#include "denoise/svgf/svgf_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    SvgfTilesParams params;
};
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D moments;
layout(set = 0, binding = 2, r32f) uniform writeonly image2D tiles;

struct Sums {
    float lag, noise, light;
};

void add(inout Sums sums, vec4 m) {
    const float counts = m.w >= 2.0 ? 1.0 : 0.0;
    sums.lag += counts * (m.z - m.x);
    sums.noise += counts * max(m.y - m.x * m.x, 0.0);
    sums.light += counts * max(m.z, m.x);
}

void main() {
    const ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 size = ivec2(params.width, params.height);
    const ivec2 first = tile * SVGF_TILE;
    if (any(greaterThanEqual(first, size))) return;
    Sums sums = Sums(0.0, 0.0, 0.0);
    for (int j = 0; j < SVGF_TILE; ++j) {
        for (int i = 0; i < SVGF_TILE; ++i) {
            const ivec2 at = first + ivec2(i, j);
            const vec4 m = imageLoad(moments, min(at, size - 1));
            add(sums, all(lessThan(at, size)) ? m : vec4(0.0));
        }
    }
    const float excess = max(abs(sums.lag) - SVGF_LAG_SIGMAS * sqrt(params.steadyShare * sums.noise), 0.0);
    const float lag = sums.light > 0.0 ? min(params.antilag * excess / sums.light, 1.0) : 0.0;
    imageStore(tiles, tile, vec4(lag));
}
