#version 460
#extension GL_EXT_scalar_block_layout : require
// The light of the next coarser level: means of 2x2 pixels, weighted by the network. `params` is of the finer level.
#include "denoise/methods/nano/shaders/nano_storage.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint LOGIT = 13u;  // the number of the weight's logarithm among a signal's logits

layout(set = 0, binding = 0, scalar) uniform Params {
    NanoFilterParams params;
};
READ_TEXELS(1, inputs);
READ_WEIGHTS(2, weights);
READ_TEXELS(3, light);
WRITE_TEXELS(4, pooled);

/// The half of this number in a texel of weights.
float weightOf(uint texel, uint number) {
    return unpackHalf2x16(LOAD_WEIGHTS(weights, texel)[number / 2u])[number % 2u];
}

/// Of four pixels, whose indices are given, the logit of each signal.
mat2x4 logitsOf(uvec4 pixels) {
    const uint all = 2u * params.logitGroups, number = LOGIT % 8u;
    const uvec2 groups = LOGIT / 8u + uvec2(0u, params.logitGroups);
    mat2x4 sums;
    [[unroll]] for (int s = 0; s < 2; ++s) sums[s] = vec4(weightOf(params.weights + groups[s], number));
    for (uint g = 0u; g < params.groups; ++g) {
        Eight x[4];
        [[unroll]] for (int p = 0; p < 4; ++p) x[p] = unpackEight(inputs.texels[pixels[p] * params.groups + g]);
        [[unroll]] for (int i = 0; i < 8; ++i) {
            const uvec2 at = params.weights + all + (g * all + groups) * 8u + uint(i);
            const vec2 w = vec2(weightOf(at.x, number), weightOf(at.y, number));
            [[unroll]] for (int p = 0; p < 4; ++p) {
                sums[0][p] += valueOf(x[p], i) * w.x;
                sums[1][p] += valueOf(x[p], i) * w.y;
            }
        }
    }
    return sums;
}

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    const uint width = params.paddedWidth / 2u;
    if (at.x >= width || at.y >= params.paddedHeight / 2u) return;
    const uint first = 2u * (at.y * params.paddedWidth + at.x), below = first + params.paddedWidth;
    const uvec4 pixels = uvec4(first, first + 1u, below, below + 1u);
    const mat2x4 logits = logitsOf(pixels);
    LightSums sums = LightSums(vec4(0.0), vec4(0.0));
    [[unroll]] for (int i = 0; i < 4; ++i)
        add(sums, lightPairOf(light.texels[pixels[i]]), exp(clamp(vec2(logits[0][i], logits[1][i]), -10.0, 10.0)));
    pooled.texels[at.y * width + at.x] = packLightPair(meanOf(sums));
}
