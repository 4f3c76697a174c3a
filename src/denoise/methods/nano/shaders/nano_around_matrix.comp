#version 460
#extension GL_EXT_scalar_block_layout : require
// A convolution of 3x3 taps and its activation, on cooperative matrices. For each slab of 16 inputs, the workgroup's
// pixels, those around them, and the weights go through shared memory. The next ones are loaded into registers while
// the current ones are multiplied.
#define PATCHES 1u
#include "denoise/methods/nano/shaders/nano_matrix.glsl"

layout(constant_id = 3) const uint SLABS = 1u;  // of 16 inputs

const uint WIDTH = COLUMNS + 2u, HEIGHT = SUBGROUPS * ROWS + 2u;             // of the pixels that the taps read
const uint ROW_TEXELS = 2u * WIDTH, ROWS_AT_ONCE = INVOCATIONS / ROW_TEXELS;  // each invocation loads from one column
const uint PIXEL_LOADS = (HEIGHT + ROWS_AT_ONCE - 1u) / ROWS_AT_ONCE;
const uint WEIGHT_TEXELS = 9u * 16u * LINE, WEIGHT_LOADS = (WEIGHT_TEXELS + INVOCATIONS - 1u) / INVOCATIONS;
const uint STEPS = LOOPS * SLABS;

shared uvec4 pixels[WIDTH * HEIGHT * PITCH];
shared uvec4 lines[9u * 16u * LINE_PITCH];  // weights

void fetchPixels(uint step, out uvec4 fetched[PIXEL_LOADS]) {
    const uint row = gl_LocalInvocationIndex / ROW_TEXELS, texel = gl_LocalInvocationIndex % ROW_TEXELS;
    const uint group = step % SLABS * 2u + texel % 2u;
    const ivec2 first = firstPixel() + ivec2(texel / 2u, step / SLABS * SUBGROUPS * ROWS + row) - 1;
    const bool inside = row < ROWS_AT_ONCE && first.x >= 0 && first.x < int(params.width);
    [[unroll]] for (uint j = 0u; j < PIXEL_LOADS; ++j) {
        const int y = first.y + int(ROWS_AT_ONCE * j);
        const bool there = inside && y >= 0 && y < int(params.height) && row + ROWS_AT_ONCE * j < HEIGHT;
        const uint pixel = uint(y) * params.width + uint(first.x);
        fetched[j] = there ? inputs.texels[pixel * 2u * SLABS + group] : uvec4(0u);
    }
}

void keepPixels(uvec4 fetched[PIXEL_LOADS]) {
    const uint row = gl_LocalInvocationIndex / ROW_TEXELS, texel = gl_LocalInvocationIndex % ROW_TEXELS;
    const uint at = (row * WIDTH + texel / 2u) * PITCH + texel % 2u;
    [[unroll]] for (uint j = 0u; j < PIXEL_LOADS; ++j) {
        if (row < ROWS_AT_ONCE && row + ROWS_AT_ONCE * j < HEIGHT)
            pixels[at + ROWS_AT_ONCE * j * WIDTH * PITCH] = fetched[j];
    }
}

/// In the order of the buffer: eight inputs, the groups of outputs, the slab's groups of inputs, taps.
void fetchWeights(uint step, out uvec4 fetched[WEIGHT_LOADS]) {
    [[unroll]] for (uint j = 0u; j < WEIGHT_LOADS; ++j) {
        const uint i = gl_LocalInvocationIndex + INVOCATIONS * j, part = i / (8u * LINE);
        const uint group = (part / 2u * SLABS + step % SLABS) * 2u + part % 2u;
        if (i < WEIGHT_TEXELS) fetched[j] = weights.texels[weightsOf(group, i % 8u, i / 8u % LINE)];
    }
}

void keepWeights(uvec4 fetched[WEIGHT_LOADS]) {
    [[unroll]] for (uint j = 0u; j < WEIGHT_LOADS; ++j) {
        const uint i = gl_LocalInvocationIndex + INVOCATIONS * j;
        if (i < WEIGHT_TEXELS) lines[(i / (8u * LINE) * 8u + i % 8u) * LINE_PITCH + i / 8u % LINE] = fetched[j];
    }
}

/// Adds a column of taps. A row of pixels serves up to three of them.
void addColumn(uint column, inout FloatMatrix sums[ROWS][TILES]) {
    HalfMatrix rows[ROWS + 2u];
    [[unroll]] for (uint m = 0u; m < ROWS + 2u; ++m)
        coopMatLoadNV(rows[m], pixels, ((ROWS * gl_SubgroupID + m) * WIDTH + column) * PITCH, PITCH, false);
    [[unroll]] for (uint row = 0u; row < 3u; ++row) {
        [[unroll]] for (uint n = 0u; n < TILES; ++n) {
            HalfMatrix w;
            coopMatLoadNV(w, lines, (3u * row + column) * 16u * LINE_PITCH + 2u * n, LINE_PITCH, false);
            [[unroll]] for (uint m = 0u; m < ROWS; ++m) sums[m][n] = coopMatMulAddNV(rows[m + row], w, sums[m][n]);
        }
    }
}

void main() {
    uvec4 nextPixels[PIXEL_LOADS], nextWeights[WEIGHT_LOADS];
    fetchPixels(0u, nextPixels);
    fetchWeights(0u, nextWeights);
    keepBiases();
    FloatMatrix sums[ROWS][TILES];
    for (uint step = 0u; step < STEPS; ++step) {
        if (step > 0u) barrier();
        keepPixels(nextPixels);
        if (SLABS > 1u || step == 0u) keepWeights(nextWeights);
        barrier();
        if (step + 1u < STEPS) {
            fetchPixels(step + 1u, nextPixels);
            if (SLABS > 1u) fetchWeights(step + 1u, nextWeights);
        }
        if (step % SLABS == 0u) {
            [[unroll]] for (uint m = 0u; m < ROWS; ++m) {
                [[unroll]] for (uint n = 0u; n < TILES; ++n) sums[m][n] = biasesOf(n);
            }
        }
        for (uint column = 0u; column < 3u; ++column) addColumn(column, sums);
        if (step % SLABS + 1u == SLABS) {
            const ivec2 first = firstPixel() + ivec2(0, (step / SLABS * SUBGROUPS + gl_SubgroupID) * ROWS);
            [[unroll]] for (uint m = 0u; m < ROWS; ++m) {
                [[unroll]] for (uint n = 0u; n < TILES; ++n) store(sums[m][n], first + ivec2(0, m), n);
            }
        }
    }
}
