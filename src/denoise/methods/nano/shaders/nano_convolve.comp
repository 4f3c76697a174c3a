#version 460
#extension GL_EXT_scalar_block_layout : require
// A convolution and its activation. An invocation computes eight channels of NANO_PIXELS pixels in a row.
#include "denoise/methods/nano/shaders/nano_storage.glsl"

layout(local_size_x = 16, local_size_y = 4) in;

layout(constant_id = 0) const uint TAPS = NANO_AROUND;

layout(set = 0, binding = 0, scalar) uniform Params {
    NanoConvolveParams params;
};
READ_TEXELS(1, inputs);
READ_TEXELS(2, coarser);  // of the next coarser level; only with NANO_POINT
READ_TEXELS(3, weights);
WRITE_TEXELS(4, outputs);

Eight sums[NANO_PIXELS];

/// Adds the products of eight inputs of each pixel with their weights, which begin at `first`.
void multiply(uvec4 taps[NANO_PIXELS], uint first) {
    Eight values[NANO_PIXELS];
    [[unroll]] for (int p = 0; p < NANO_PIXELS; ++p) values[p] = unpackEight(taps[p]);
    [[unroll]] for (int i = 0; i < 8; ++i) {
        const Eight w = unpackEight(weights.texels[first + uint(i)]);
        [[unroll]] for (int p = 0; p < NANO_PIXELS; ++p) addProduct(sums[p], valueOf(values[p], i), w);
    }
}

/// A pixel's texel of `inputs`. `size`: the pixels that there are; others are 0.
uvec4 inputAt(ivec2 at, ivec2 size, uint group) {
    const bool there = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, size));
    return there ? inputs.texels[(uint(at.y) * uint(size.x) + uint(at.x)) * params.groups + group] : uvec4(0u);
}

/// `number`: the index of the first of its weights.
void addTap(ivec2 first, ivec2 from, int scale, uint number, uint group) {
    const ivec2 size = scale * ivec2(params.width, params.height);
    uvec4 taps[NANO_PIXELS];
    [[unroll]] for (int p = 0; p < NANO_PIXELS; ++p)
        taps[p] = inputAt(scale * (first + ivec2(p, 0)) + from, size, group);
    multiply(taps, number);
}

void addCoarser(ivec2 first, uint group, uint at) {
    const uint pitch = params.width / 2u;
    uvec4 taps[NANO_PIXELS];
    [[unroll]] for (int p = 0; p < NANO_PIXELS; ++p) {
        const uvec2 covers = uvec2(min(uint(first.x) + uint(p), params.width - 1u), uint(first.y)) / 2u;
        taps[p] = coarser.texels[(covers.y * pitch + covers.x) * params.coarserGroups + group];
    }
    multiply(taps, at);
}

void main() {
    const uint row = gl_GlobalInvocationID.y;
    const uint outputGroup = row / params.height;
    const ivec2 first = ivec2(gl_GlobalInvocationID.x * NANO_PIXELS, row % params.height);
    if (first.x >= int(params.width) || outputGroup >= params.outputGroups) return;
    const Eight bias = unpackEight(weights.texels[params.weights + outputGroup]);
    [[unroll]] for (int p = 0; p < NANO_PIXELS; ++p) sums[p] = bias;
    const int edge = TAPS == NANO_AROUND ? 3 : TAPS == NANO_HALVE ? 2 : 1;
    const uint block = 8u * params.outputGroups;  // texels of a tap's eight inputs
    uint at = params.weights + params.outputGroups + 8u * outputGroup;
    for (int tap = 0; tap < edge * edge; ++tap) {
        ivec2 from = ivec2(tap % edge, tap / edge);
        if (TAPS == NANO_AROUND) from -= 1;
        for (uint group = 0u; group < params.groups; ++group, at += block)
            addTap(first, from, TAPS == NANO_HALVE ? 2 : 1, at, group);
        if (TAPS != NANO_POINT) continue;
        for (uint group = 0u; group < params.coarserGroups; ++group, at += block) addCoarser(first, group, at);
    }
    [[unroll]] for (int p = 0; p < NANO_PIXELS; ++p) {
        const uint x = uint(first.x) + uint(p);
        if (x >= params.width) break;
        outputs.texels[(uint(first.y) * params.width + x) * params.outputGroups + outputGroup] =
            packEight(Eight(leaky(sums[p].low), leaky(sums[p].high)));
    }
}
