#version 460
#extension GL_EXT_scalar_block_layout : require
// A convolution of 1x1 or 2x2 taps and its activation, on cooperative matrices. No two pixels share inputs, so each
// subgroup has its own in shared memory: PATCHES slabs of 16 inputs of 16 pixels at a time. The next ones are loaded
// into registers meanwhile.
#define PATCHES 4u
#include "denoise/methods/nano/shaders/nano_matrix.glsl"

layout(constant_id = 3) const uint SLABS = 1u;      // of 16 inputs, of all taps
layout(constant_id = 4) const uint OWN_SLABS = 1u;  // of a pixel of `inputs`
layout(constant_id = 5) const bool HALVES = false;  // 2x2 taps

READ_TEXELS(4, coarser);  // of the next coarser level; only without HALVES

const uint WEIGHT_TEXELS = SLABS * 16u * LINE, WEIGHT_LOADS = (WEIGHT_TEXELS + INVOCATIONS - 1u) / INVOCATIONS;

shared uvec4 lines[SLABS * 16u * LINE_PITCH];  // weights

/// Loads all before it stores any, so as to wait once.
void keepWeights() {
    uvec4 fetched[WEIGHT_LOADS];
    [[unroll]] for (uint j = 0u; j < WEIGHT_LOADS; ++j) {
        const uint i = gl_LocalInvocationIndex + INVOCATIONS * j;
        if (i < WEIGHT_TEXELS) fetched[j] = weights.texels[weightsOf(i / (8u * LINE), i % 8u, i / 8u % LINE)];
    }
    [[unroll]] for (uint j = 0u; j < WEIGHT_LOADS; ++j) {
        const uint i = gl_LocalInvocationIndex + INVOCATIONS * j;
        if (i < WEIGHT_TEXELS) lines[(i / (8u * LINE) * 8u + i % 8u) * LINE_PITCH + i / 8u % LINE] = fetched[j];
    }
}

/// This invocation's texel of a slab, half a pixel's. `at`: the pixel of the outputs.
uvec4 texelOf(uvec2 at, uint slab) {
    const uint part = gl_SubgroupInvocationID % 2u;
    if (at.x >= params.width || at.y >= params.height) return uvec4(0u);
    if (HALVES) {
        const uint tap = slab / OWN_SLABS;
        const uvec2 from = 2u * at + uvec2(tap % 2u, tap / 2u);
        return inputs.texels[((from.y * 2u * params.width + from.x) * OWN_SLABS + slab % OWN_SLABS) * 2u + part];
    }
    if (slab < OWN_SLABS) return inputs.texels[((at.y * params.width + at.x) * OWN_SLABS + slab) * 2u + part];
    const uvec2 covers = at / 2u;
    const uint pixel = covers.y * (params.width / 2u) + covers.x;
    return coarser.texels[(pixel * (SLABS - OWN_SLABS) + slab - OWN_SLABS) * 2u + part];
}

void fetch(uvec2 at, uint slab, out uvec4 fetched[PATCHES]) {
    [[unroll]] for (uint j = 0u; j < PATCHES; ++j)
        fetched[j] = slab + j < SLABS ? texelOf(at, slab + j) : uvec4(0u);
}

void keep(uvec4 fetched[PATCHES]) {
    const uint lane = gl_SubgroupInvocationID;
    const uint at = gl_SubgroupID * PATCHES * PATCH + lane / 2u * PITCH + lane % 2u;
    sharedBarrier();
    [[unroll]] for (uint j = 0u; j < PATCHES; ++j) patches[at + j * PATCH] = fetched[j];
    sharedBarrier();
}

void addSlabs(uint slab, inout FloatMatrix sums[TILES]) {
    [[unroll]] for (uint j = 0u; j < PATCHES; ++j) {
        if (slab + j >= SLABS) break;
        HalfMatrix pixels;
        coopMatLoadNV(pixels, patches, (gl_SubgroupID * PATCHES + j) * PATCH, PITCH, false);
        [[unroll]] for (uint n = 0u; n < TILES; ++n) {
            HalfMatrix w;
            coopMatLoadNV(w, lines, (slab + j) * 16u * LINE_PITCH + 2u * n, LINE_PITCH, false);
            sums[n] = coopMatMulAddNV(pixels, w, sums[n]);
        }
    }
}

void main() {
    const uvec2 first = uvec2(firstPixel()) + uvec2(0u, ROWS * gl_SubgroupID);
    const uvec2 own = first + uvec2(gl_SubgroupInvocationID / 2u, 0u);
    uvec4 next[PATCHES];
    fetch(own, 0u, next);
    keepBiases();
    keepWeights();
    barrier();
    for (uint row = 0u; row < ROWS; ++row) {
        FloatMatrix sums[TILES];
        [[unroll]] for (uint n = 0u; n < TILES; ++n) sums[n] = biasesOf(n);
        [[unroll]] for (uint slab = 0u; slab < SLABS; slab += PATCHES) {
            keep(next);
            const bool last = slab + PATCHES >= SLABS;
            if (!last || row + 1u < ROWS)
                fetch(own + uvec2(0u, last ? row + 1u : row), last ? 0u : slab + PATCHES, next);
            addSlabs(slab, sums);
        }
        [[unroll]] for (uint n = 0u; n < TILES; ++n) store(sums[n], ivec2(first + uvec2(0u, row)), n);
    }
}
