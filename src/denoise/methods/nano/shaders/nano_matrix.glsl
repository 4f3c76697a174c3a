// What the convolutions on cooperative matrices share. A workgroup computes TILES x 16 channels of 16 columns of
// pixels, each of its subgroups ROWS rows of them, LOOPS times. Products are of halves, sums in single precision.
//
// Matrices come from shared memory. There, a pixel's 16 channels have a texel of padding, and so has a line of weights:
// that avoids bank conflicts. PATCHES is defined beforehand.
//
// Loops over matrices are unrolled explicitly: otherwise NVIDIA's compiler keeps the matrices in memory.
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_memory_scope_semantics : require
#extension GL_NV_cooperative_matrix : require
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
#include "denoise/methods/nano/shaders/nano_storage.glsl"

#ifdef LIMPID_NANO_SMALL
const uint SUBGROUPS = NANO_SMALL_SUBGROUPS, INVOCATIONS = 128u;
layout(local_size_x = 128) in;
#else
const uint SUBGROUPS = NANO_SUBGROUPS, INVOCATIONS = 256u;
layout(local_size_x = 256) in;
#endif

layout(constant_id = 0) const uint TILES = 1u;
layout(constant_id = 1) const uint ROWS = 1u;
layout(constant_id = 2) const uint LOOPS = 1u;

layout(set = 0, binding = 0, scalar) uniform Params {
    NanoConvolveParams params;
};
READ_TEXELS(1, inputs);
READ_TEXELS(2, weights);
WRITE_TEXELS(3, outputs);

#define HalfMatrix fcoopmatNV<16, gl_ScopeSubgroup, 16, 16>
#define FloatMatrix fcoopmatNV<32, gl_ScopeSubgroup, 16, 16>

const uint COLUMNS = NANO_COLUMNS;
const uint PITCH = 3u;                                 // texels of a pixel's 16 channels in shared memory
const uint LINE = 2u * TILES, LINE_PITCH = LINE + 1u;  // texels of the weights of one input
const uint PATCH = COLUMNS * PITCH;

shared uvec4 patches[SUBGROUPS * PATCHES * PATCH];  // each subgroup has some; outputs go through the first
shared uvec4 biases[16u * LINE_PITCH];              // sixteen equal lines

/// For what a subgroup alone has in shared memory. (subgroupBarrier() also waits for what it reads from buffers.)
void sharedBarrier() {
    controlBarrier(gl_ScopeSubgroup, gl_ScopeSubgroup, gl_StorageSemanticsShared, gl_SemanticsAcquireRelease);
}

/// Workgroups on top of each other.
uint blocks() {
    return (params.height + SUBGROUPS * ROWS * LOOPS - 1u) / (SUBGROUPS * ROWS * LOOPS);
}

ivec2 firstPixel() {
    return ivec2(gl_WorkGroupID.x * COLUMNS, gl_WorkGroupID.y % blocks() * SUBGROUPS * ROWS * LOOPS);
}

/// The workgroup's first group of outputs.
uint firstGroup() {
    return gl_WorkGroupID.y / blocks() * LINE;
}

void keepBiases() {
    for (uint i = gl_LocalInvocationIndex; i < 16u * LINE; i += INVOCATIONS)
        biases[i / LINE * LINE_PITCH + i % LINE] = weights.texels[params.weights + firstGroup() + i % LINE];
}

FloatMatrix biasesOf(uint tile) {
    HalfMatrix bias;
    coopMatLoadNV(bias, biases, 2u * tile, LINE_PITCH, false);
    return FloatMatrix(bias);
}

/// The index of the weights of input `number` of a group, for the group of outputs `column` of the workgroup's. `group`
/// counts the groups of inputs of all taps.
uint weightsOf(uint group, uint number, uint column) {
    return params.weights + params.outputGroups + (group * params.outputGroups + firstGroup() + column) * 8u + number;
}

/// Applies the activation to 16 pixels from `first` on, and stores them.
void store(FloatMatrix sums, ivec2 first, uint tile) {
    for (int i = 0; i < sums.length(); ++i) sums[i] = clamp(max(sums[i], 0.1 * sums[i]), -MAX_HALF, MAX_HALF);
    const uint at = gl_SubgroupID * PATCHES * PATCH;
    sharedBarrier();  // what the subgroup has read from there
    coopMatStoreNV(HalfMatrix(sums), patches, at, PITCH, false);
    sharedBarrier();
    const uint pixel = gl_SubgroupInvocationID / 2u, part = gl_SubgroupInvocationID % 2u;
    const uint x = uint(first.x) + pixel, y = uint(first.y);
    if (x < params.width && y < params.height)
        outputs.texels[(y * params.width + x) * params.outputGroups + firstGroup() + 2u * tile + part] =
            patches[at + pixel * PITCH + part];
    sharedBarrier();
}
