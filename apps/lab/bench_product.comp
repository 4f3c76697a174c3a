#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_memory_scope_semantics : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_NV_cooperative_matrix : require
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
// A product of square matrices of halves on cooperative matrices, with sums in single precision: `limpid
// bench kpcn` compares the network with it. A workgroup computes 128x128 sums, a subgroup 64x32.
layout(local_size_x = 16, local_size_y = 16) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    uint size;  // a multiple of 128
} params;
layout(set = 0, binding = 1, scalar) readonly buffer LeftTexels { uvec4 texels[]; } left;
layout(set = 0, binding = 2, scalar) readonly buffer RightTexels { uvec4 texels[]; } right;
layout(set = 0, binding = 3, scalar) writeonly buffer ResultTexels { uvec4 texels[]; } result;

#define HalfMatrix fcoopmatNV<16, gl_ScopeSubgroup, 16, 16>
#define FloatMatrix fcoopmatNV<32, gl_ScopeSubgroup, 16, 16>

const uint EDGE = 128u, DEPTH = 32u;
const uint LEFT_PITCH = DEPTH / 8u + 1u, RIGHT_PITCH = EDGE / 8u + 1u;
const uint RIGHT_AT = EDGE * LEFT_PITCH;

shared uvec4 stage[RIGHT_AT + DEPTH * RIGHT_PITCH];

void fetch(uint depth, out uvec4 a[2], out uvec4 b[2]) {
    const uint line = params.size / 8u;
    [[unroll]] for (uint j = 0u; j < 2u; ++j) {
        const uint i = gl_LocalInvocationIndex + 256u * j;
        a[j] = left.texels[(gl_WorkGroupID.y * EDGE + i / 4u) * line + depth / 8u + i % 4u];
        b[j] = right.texels[(depth + i / 16u) * line + gl_WorkGroupID.x * EDGE / 8u + i % 16u];
    }
}

void main() {
    const uint row = gl_SubgroupID / 4u * 64u, column = gl_SubgroupID % 4u * 32u;
    FloatMatrix sums[4][2];
    [[unroll]] for (uint m = 0u; m < 4u; ++m) {
        [[unroll]] for (uint n = 0u; n < 2u; ++n) sums[m][n] = FloatMatrix(0.0);
    }
    uvec4 a[2], b[2];
    fetch(0u, a, b);
    for (uint depth = 0u; depth < params.size; depth += DEPTH) {
        barrier();
        [[unroll]] for (uint j = 0u; j < 2u; ++j) {
            const uint i = gl_LocalInvocationIndex + 256u * j;
            stage[i / 4u * LEFT_PITCH + i % 4u] = a[j];
            stage[RIGHT_AT + i / 16u * RIGHT_PITCH + i % 16u] = b[j];
        }
        barrier();
        if (depth + DEPTH < params.size) fetch(depth + DEPTH, a, b);
        for (uint k = 0u; k < DEPTH / 16u; ++k) {
            HalfMatrix lefts[4], rights[2];
            [[unroll]] for (uint m = 0u; m < 4u; ++m)
                coopMatLoadNV(lefts[m], stage, (row + 16u * m) * LEFT_PITCH + 2u * k, LEFT_PITCH, false);
            [[unroll]] for (uint n = 0u; n < 2u; ++n)
                coopMatLoadNV(rights[n], stage, RIGHT_AT + 16u * k * RIGHT_PITCH + column / 8u + 2u * n, RIGHT_PITCH, false);
            [[unroll]] for (uint m = 0u; m < 4u; ++m) {
                [[unroll]] for (uint n = 0u; n < 2u; ++n) sums[m][n] = coopMatMulAddNV(lefts[m], rights[n], sums[m][n]);
            }
        }
    }
    [[unroll]] for (uint m = 0u; m < 4u; ++m) {
        [[unroll]] for (uint n = 0u; n < 2u; ++n) {
            const uint at = (gl_WorkGroupID.y * EDGE + row + 16u * m) * params.size / 8u +
                            (gl_WorkGroupID.x * EDGE + column) / 8u + 2u * n;
            coopMatStoreNV(HalfMatrix(sums[m][n]), result.texels, at, params.size / 8u, false);
        }
    }
}
