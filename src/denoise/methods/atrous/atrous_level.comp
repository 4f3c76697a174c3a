#version 460
#extension GL_EXT_scalar_block_layout : require
// atrous_level.glsl with gpu::Backing::Image, for CPUs. Reading is what costs there: an invocation filters 4x2 pixels that
// lie a step apart, of whose 8 x 25 taps only 48 are different.
#include "denoise/methods/atrous/atrous_level.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const ivec2 BLOCK = ivec2(4, 2);  // as in atrous.cpp

Centre centres[8];

/// `number` and `from` are known when this is compiled.
void addToOne(int number, Tap tap, ivec2 from) {
    if (abs(from.x) <= 2 && abs(from.y) <= 2 && from != ivec2(0)) addTo(centres[number], tap, from);
}

void addTap(ivec2 first, int i, int j) {
    const Tap tap = loadTap(first + params.step * ivec2(i, j));
    addToOne(0, tap, ivec2(i, j));
    addToOne(1, tap, ivec2(i - 1, j));
    addToOne(2, tap, ivec2(i - 2, j));
    addToOne(3, tap, ivec2(i - 3, j));
    addToOne(4, tap, ivec2(i, j - 1));
    addToOne(5, tap, ivec2(i - 1, j - 1));
    addToOne(6, tap, ivec2(i - 2, j - 1));
    addToOne(7, tap, ivec2(i - 3, j - 1));
}

// Spelled out rather than looped: only so is it certain that the compiler keeps the centres in registers.
void addRow(ivec2 first, int j) {
    addTap(first, -2, j);
    addTap(first, -1, j);
    addTap(first, 0, j);
    addTap(first, 1, j);
    addTap(first, 2, j);
    addTap(first, 3, j);
    addTap(first, 4, j);
    addTap(first, 5, j);
}

ivec2 pixelOfBlock(ivec2 first, int number) {
    return first + params.step * ivec2(number % BLOCK.x, number / BLOCK.x);
}

void begin(ivec2 first, int number) {
    const ivec2 at = pixelOfBlock(first, number);
    centres[number] = centreOf(loadTap(at), at);
}

void finish(ivec2 first, int number) {
    store(pixelOfBlock(first, number), centres[number]);
}

void main() {
    const ivec2 invocation = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 first = invocation / params.step * (BLOCK * params.step) + invocation % params.step;
    if (first.x >= int(params.width) || first.y >= int(params.height)) return;
    begin(first, 0);
    begin(first, 1);
    begin(first, 2);
    begin(first, 3);
    begin(first, 4);
    begin(first, 5);
    begin(first, 6);
    begin(first, 7);
    addRow(first, -2);
    addRow(first, -1);
    addRow(first, 0);
    addRow(first, 1);
    addRow(first, 2);
    addRow(first, 3);
    finish(first, 0);
    finish(first, 1);
    finish(first, 2);
    finish(first, 3);
    finish(first, 4);
    finish(first, 5);
    finish(first, 6);
    finish(first, 7);
}
