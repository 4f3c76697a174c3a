#version 460
#extension GL_EXT_scalar_block_layout : require
// Writes the first stratified numbers of a sample of each pixel: draws of two dimensions and of one, in turn.
#include "shaders/common/sobol_table.h"

layout(local_size_x = 64) in;

const uint DRAWS = 8u;

layout(set = 0, binding = 0, scalar) uniform Params {
    SobolTable points;
    uint count, width, stream, seed;
    uint index;  // of the sample in its launch
} params;

#define SOBOL_TABLE params.points
#include "shaders/common/rng.glsl"

layout(set = 0, binding = 1, scalar) writeonly buffer Results {
    uint words[];
} results;

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count) return;
    uint state = startStream(i, params.stream, params.seed);
    startSample(uvec2(i % params.width, i / params.width), params.index);
    for (uint n = 0u; n < DRAWS; ++n) {
        vec2 u = vec2(0.0);
        if (n % 2u == 0u) u = stratified2(state);
        else u.x = stratified(state);
        results.words[(i * DRAWS + n) * 2u] = floatBitsToUint(u.x);
        results.words[(i * DRAWS + n) * 2u + 1u] = floatBitsToUint(u.y);
    }
}
