// A convolution of 5x5 taps as products of cooperative matrices. A workgroup computes TILES x 16 channels of 16x16
// pixels; each of its eight subgroups computes two rows of pixels. Products are in half precision, sums in single
// precision.
//
// Inputs and weights go through shared memory: for each slab of input channels the 20x20 pixels around the workgroup,
// and for each row of taps its weights.
//
// Loops over matrices are unrolled explicitly: otherwise NVIDIA's compiler keeps the matrices in memory, which is five
// times slower.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_memory_scope_semantics : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_NV_cooperative_matrix : require
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
#include "denoise/kpcn/kpcn_params.h"

layout(local_size_x = 16, local_size_y = 16) in;

layout(constant_id = 0) const uint TILES = 7u;  // tiles of 16 outputs at a time, at most 8; divides outputTiles

layout(set = 0, binding = 0, scalar) uniform Params {
    KpcnLayerParams params;
};
// A texel holds eight halves.
layout(set = 0, binding = 1, scalar) readonly buffer inputTexels { uvec4 texels[]; } inputs;
layout(set = 0, binding = 2, scalar) readonly buffer weightTexels { uvec4 texels[]; } weights;

#define HalfMatrix fcoopmatNV<16, gl_ScopeSubgroup, 16, 16>
#define FloatMatrix fcoopmatNV<32, gl_ScopeSubgroup, 16, 16>

const uint EDGE = 16u;                         // edge length of a workgroup in pixels
const uint HALO = EDGE + KPCN_TAPS - 1u;       // including the pixels that its taps read around it
const uint HALO_PITCH = 3u;                    // uvec4 per pixel; one is padding that avoids bank conflicts
const uint HALO_LOADS = (HALO * HALO * 2u + 255u) / 256u;
const uint WEIGHTS_AT = HALO * HALO * HALO_PITCH;
const uint WEIGHT_LINES = KPCN_TAPS * KPCN_SLAB;  // lines of weights in a row of taps: one per tap and input
const uint WEIGHT_LOADS = WEIGHT_LINES * 16u / 256u;
const uint WEIGHT_PITCH = 2u * TILES + 1u;
const uint SHARED_TEXELS = WEIGHTS_AT + WEIGHT_LINES * 17u;

shared uvec4 stage[SHARED_TEXELS];

ivec2 groupsFirst() {
    return ivec2(params.region.left, params.region.top) + ivec2(gl_WorkGroupID.xy * EDGE);
}

uint slabTexel(uint slab, ivec2 pixel) {
    return ((slab * uint(params.region.rows) + uint(pixel.y - params.region.originY)) * uint(params.region.pitch) +
            uint(pixel.x - params.region.originX)) * 2u;
}

void fetchHalo(uint slab, out uvec4 fetched[HALO_LOADS]) {
    [[unroll]] for (uint j = 0u; j < HALO_LOADS; ++j) {
        const uint i = gl_LocalInvocationIndex + 256u * j;
        const uint place = i / 2u;
        const ivec2 pixel = groupsFirst() + ivec2(place % HALO, place / HALO) - int(KPCN_TAPS / 2u);
        const bool there = place < HALO * HALO && pixel.x >= 0 && pixel.y >= 0 &&
                           pixel.x < params.region.pictureWidth && pixel.y < params.region.pictureHeight;
        fetched[j] = there ? inputs.texels[slabTexel(slab, pixel) + i % 2u] : uvec4(0u);
    }
}

void keepHalo(uvec4 fetched[HALO_LOADS]) {
    [[unroll]] for (uint j = 0u; j < HALO_LOADS; ++j) {
        const uint i = gl_LocalInvocationIndex + 256u * j;
        if (i / 2u < HALO * HALO) stage[i / 2u * HALO_PITCH + i % 2u] = fetched[j];
    }
}

/// Loads the weights of one row of taps and one slab of inputs, for the output tiles from `tile` on.
void fetchWeights(uint slab, uint row, uint tile, out uvec4 fetched[WEIGHT_LOADS]) {
    const uint line = 2u * params.outputTiles;
    const uint first = params.weights + (slab * KPCN_TAPS + row) * WEIGHT_LINES * line + tile * 2u;
    [[unroll]] for (uint j = 0u; j < WEIGHT_LOADS; ++j) {
        const uint i = gl_LocalInvocationIndex + 256u * j;
        if (i < WEIGHT_LINES * 2u * TILES) fetched[j] = weights.texels[first + i / (2u * TILES) * line + i % (2u * TILES)];
    }
}

void keepWeights(uvec4 fetched[WEIGHT_LOADS]) {
    [[unroll]] for (uint j = 0u; j < WEIGHT_LOADS; ++j) {
        const uint i = gl_LocalInvocationIndex + 256u * j;
        if (i < WEIGHT_LINES * 2u * TILES)
            stage[WEIGHTS_AT + i / (2u * TILES) * WEIGHT_PITCH + i % (2u * TILES)] = fetched[j];
    }
}

/// Computes TILES tiles of output channels from `tile` on: sums[row of pixels of the subgroup][tile]. The next inputs
/// and weights are loaded into registers while the current ones are multiplied.
void convolve(uint tile, out FloatMatrix sums[2][TILES]) {
    [[unroll]] for (uint m = 0u; m < 2u; ++m) {
        [[unroll]] for (uint n = 0u; n < TILES; ++n) sums[m][n] = FloatMatrix(0.0);
    }
    uvec4 halo[HALO_LOADS], lines[WEIGHT_LOADS];
    fetchHalo(0u, halo);
    fetchWeights(0u, 0u, tile, lines);
    for (uint slab = 0u; slab < params.inputSlabs; ++slab) {
        for (uint row = 0u; row < KPCN_TAPS; ++row) {
            barrier();
            if (row == 0u) keepHalo(halo);
            keepWeights(lines);
            barrier();
            const bool last = row + 1u == KPCN_TAPS;
            if (last && slab + 1u < params.inputSlabs) fetchHalo(slab + 1u, halo);
            if (!last || slab + 1u < params.inputSlabs)
                fetchWeights(last ? slab + 1u : slab, last ? 0u : row + 1u, tile, lines);
            for (uint tap = 0u; tap < KPCN_TAPS; ++tap) {
                HalfMatrix pixels[2];
                [[unroll]] for (uint m = 0u; m < 2u; ++m)
                    coopMatLoadNV(pixels[m], stage, ((2u * gl_SubgroupID + m + row) * HALO + tap) * HALO_PITCH, HALO_PITCH, false);
                [[unroll]] for (uint n = 0u; n < TILES; ++n) {
                    HalfMatrix w;
                    coopMatLoadNV(w, stage, WEIGHTS_AT + tap * KPCN_SLAB * WEIGHT_PITCH + 2u * n, WEIGHT_PITCH, false);
                    [[unroll]] for (uint m = 0u; m < 2u; ++m) sums[m][n] = coopMatMulAddNV(pixels[m], w, sums[m][n]);
                }
            }
        }
    }
}
