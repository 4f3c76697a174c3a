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

const int PIXELS = 4;
#include "denoise/methods/nano/shaders/nano_logits.glsl"

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    const uint width = params.paddedWidth / 2u;
    if (at.x >= width || at.y >= params.paddedHeight / 2u) return;
    uint pixels[PIXELS];
    [[unroll]] for (uint i = 0u; i < 4u; ++i)
        pixels[i] = (2u * at.y + i / 2u) * params.paddedWidth + 2u * at.x + i % 2u;
    const uint group = LOGIT / 8u;
    const LogitsOfPixels a = logitsOf(pixels, group), b = logitsOf(pixels, params.logitGroups + group);
    LightSums sums = LightSums(vec4(0.0), vec4(0.0));
    [[unroll]] for (int i = 0; i < 4; ++i) {
        const vec2 logits = vec2(logitOf(a.values[i], int(LOGIT)), logitOf(b.values[i], int(LOGIT)));
        add(sums, lightPairOf(light.texels[pixels[i]]), exp(clamp(logits, -10.0, 10.0)));
    }
    pooled.texels[at.y * width + at.x] = packLightPair(meanOf(sums));
}
