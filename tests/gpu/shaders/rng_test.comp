#version 460
#extension GL_EXT_scalar_block_layout : require
// Writes the seed of each thread's stream, then the first numbers of the stream.
#include "shaders/common/rng.glsl"

layout(local_size_x = 64) in;

const uint NUMBERS = 64u;

layout(set = 0, binding = 0, scalar) uniform Params {
    uint count, frame, seed;
} params;
layout(set = 0, binding = 1, scalar) writeonly buffer Results {
    uint words[];
} results;

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count) return;
    uint state = startStream(i, params.frame, params.seed);
    results.words[i * (NUMBERS + 2u)] = tea(i, params.frame);
    results.words[i * (NUMBERS + 2u) + 1u] = state;
    for (uint n = 0u; n < NUMBERS; ++n) results.words[i * (NUMBERS + 2u) + 2u + n] = floatBitsToUint(random(state));
}
