#version 460
#extension GL_EXT_scalar_block_layout : require
// A convolution and its activation. An invocation computes eight channels of PIXELS pixels in a row.
#include "denoise/methods/nano/shaders/nano_storage.glsl"

layout(local_size_x = 16, local_size_y = 4) in;

const int PIXELS = NANO_PIXELS;
layout(constant_id = 0) const uint TAPS = NANO_AROUND;

layout(set = 0, binding = 0, scalar) uniform Params {
    NanoConvolveParams params;
};
READ_TEXELS(1, inputs);
READ_TEXELS(2, coarser);  // of the next coarser level; only with NANO_POINT
READ_WEIGHTS(3, weights);
WRITE_TEXELS(4, outputs);

Eight sums[PIXELS];

/// Eight inputs of the invocation's pixels; with NANO_AROUND, first those of the pixel before, and last of that behind.
struct Row {
    Eight values[PIXELS + 2];
};

/// Adds the products of the row, from this value on, with their weights, which begin at `first`.
void multiply(Row row, int from, uint first) {
    [[unroll]] for (int i = 0; i < 8; ++i) {
        const Eight w = unpackEight(LOAD_WEIGHTS(weights, first + uint(i)));
        [[unroll]] for (int p = 0; p < PIXELS; ++p) addProduct(sums[p], valueOf(row.values[p + from], i), w);
    }
}

/// A pixel's texel of `inputs`. `size`: the pixels that there are; others are 0.
uvec4 inputAt(ivec2 at, ivec2 size, uint group) {
    const bool there = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, size));
    return there ? inputs.texels[(uint(at.y) * uint(size.x) + uint(at.x)) * params.groups + group] : uvec4(0u);
}

/// The next weights of the outputs of this invocation.
uint next(inout uint at) {
    const uint now = at;
    at += 8u * params.outputGroups;
    return now;
}

void addAround(ivec2 first, uint at) {
    const uint tap = 8u * params.outputGroups * params.groups;  // texels of one
    for (int y = 0; y < 3; ++y, at += 2u * tap) {
        for (uint group = 0u; group < params.groups; ++group) {
            Row row;
            [[unroll]] for (int p = 0; p < PIXELS + 2; ++p)
                row.values[p] =
                    unpackEight(inputAt(first + ivec2(p, y) - 1, ivec2(params.width, params.height), group));
            const uint weightsAt = next(at);
            [[unroll]] for (int x = 0; x < 3; ++x) multiply(row, x, weightsAt + uint(x) * tap);
        }
    }
}

void addWithin(ivec2 first, int edge, inout uint at) {
    const ivec2 size = edge * ivec2(params.width, params.height);
    for (int tap = 0; tap < edge * edge; ++tap) {
        for (uint group = 0u; group < params.groups; ++group) {
            Row row;
            [[unroll]] for (int p = 0; p < PIXELS; ++p)
                row.values[p] =
                    unpackEight(inputAt(edge * (first + ivec2(p, 0)) + ivec2(tap % edge, tap / edge), size, group));
            multiply(row, 0, next(at));
        }
    }
}

void addCoarser(ivec2 first, uint at) {
    const uint pitch = params.width / 2u;
    for (uint group = 0u; group < params.coarserGroups; ++group) {
        Row row;
        [[unroll]] for (int p = 0; p < PIXELS; ++p) {
            const uvec2 covers = uvec2(min(uint(first.x) + uint(p), params.width - 1u), uint(first.y)) / 2u;
            row.values[p] = unpackEight(coarser.texels[(covers.y * pitch + covers.x) * params.coarserGroups + group]);
        }
        multiply(row, 0, next(at));
    }
}

void main() {
    const uint row = gl_GlobalInvocationID.y;
    const uint outputGroup = row / params.height;
    const ivec2 first = ivec2(gl_GlobalInvocationID.x * PIXELS, row % params.height);
    if (first.x >= int(params.width) || outputGroup >= params.outputGroups) return;
    const Eight bias = unpackEight(LOAD_WEIGHTS(weights, params.weights + outputGroup));
    [[unroll]] for (int p = 0; p < PIXELS; ++p) sums[p] = bias;
    uint at = params.weights + params.outputGroups + 8u * outputGroup;
    if (TAPS == NANO_AROUND) {
        addAround(first, at);
    } else {
        addWithin(first, TAPS == NANO_HALVE ? 2 : 1, at);
        if (TAPS == NANO_POINT) addCoarser(first, at);
    }
    [[unroll]] for (int p = 0; p < PIXELS; ++p) {
        const uint x = uint(first.x) + uint(p);
        if (x >= params.width) break;
        outputs.texels[(uint(first.y) * params.width + x) * params.outputGroups + outputGroup] =
            packEight(Eight(leaky(sums[p].low), leaky(sums[p].high)));
    }
}
