#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
// atrous_level.glsl with gpu::Backing::Buffer, for GPUs. Decoding taps is what costs there: an invocation filters 2x2
// pixels that lie a step apart, of whose 4 x 25 taps 36 are different. More pixels need more registers than there are.
#define LIMPID_FILTER_BUFFERS
#include "denoise/methods/atrous/atrous_level.glsl"

layout(local_size_x = 32, local_size_y = 4) in;

const ivec2 BLOCK = ivec2(2, 2);  // as in atrous.cpp
const int COUNT = BLOCK.x * BLOCK.y;

ivec2 inBlock(int number) {
    return ivec2(number % BLOCK.x, number / BLOCK.x);
}

void main() {
    const ivec2 invocation = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 first = invocation / params.step * (BLOCK * params.step) + invocation % params.step;
    if (first.x >= int(params.width) || first.y >= int(params.height)) return;
    Centre centres[COUNT];
    bool anySeen = false;
    [[unroll]] for (int number = 0; number < COUNT; ++number) {
        const ivec2 at = first + params.step * inBlock(number);
        centres[number] = centreOf(loadTap(at), at);
        anySeen = anySeen || centres[number].seen;
    }
    if (anySeen) {
        [[unroll]] for (int j = -2; j < BLOCK.y + 2; ++j) {
            [[unroll]] for (int i = -2; i < BLOCK.x + 2; ++i) {
                const Tap tap = loadTap(first + params.step * ivec2(i, j));
                [[unroll]] for (int number = 0; number < COUNT; ++number) {
                    const ivec2 from = ivec2(i, j) - inBlock(number);
                    if (abs(from.x) <= 2 && abs(from.y) <= 2 && from != ivec2(0)) addTo(centres[number], tap, from);
                }
            }
        }
    }
    [[unroll]] for (int number = 0; number < COUNT; ++number)
        store(first + params.step * inBlock(number), centres[number]);
}
