// A convolution of 5x5 taps for any device: each invocation computes 16 channels of 4 horizontally adjacent pixels.
#include "denoise/kpcn/shaders/kpcn_storage.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    KpcnLayerParams params;
};
layout(set = 0, binding = 1, scalar) readonly buffer inputTexels { KPCN_TEXEL texels[]; } inputs;
layout(set = 0, binding = 2, scalar) readonly buffer weightTexels { KPCN_TEXEL texels[]; } weights;

const int BLOCK = 4;                    // pixels per invocation
const int REACH = int(KPCN_TAPS) / 2;

/// Computes one tile of 16 output channels for BLOCK pixels from `first` on: sums[pixel][channel / 4][channel % 4].
void convolve(ivec2 first, uint tile, out vec4 sums[BLOCK][4]) {
    for (int p = 0; p < BLOCK; ++p) {
        for (int o = 0; o < 4; ++o) sums[p][o] = vec4(0.0);
    }
    const uint line = params.outputTiles * 4u;  // texels per input channel and tap: the weights of all outputs
    for (uint slab = 0u; slab < params.inputSlabs; ++slab) {
        for (uint row = 0u; row < KPCN_TAPS; ++row) {
            for (uint group = 0u; group < 4u; ++group) {
                vec4 x[BLOCK + 2 * REACH];
                for (int i = 0; i < BLOCK + 2 * REACH; ++i) {
                    const ivec2 pixel = first + ivec2(i - REACH, int(row) - REACH);
                    x[i] = inPicture(params.region, pixel)
                               ? fromTexel(inputs.texels[channelTexel(params.region, slab, pixel) + group])
                               : vec4(0.0);
                }
                for (int tap = 0; tap < int(KPCN_TAPS); ++tap) {
                    uint at = params.weights * 2u + ((slab * KPCN_TAPS + row) * KPCN_TAPS + uint(tap)) * KPCN_SLAB * line +
                              group * 4u * line + tile * 4u;
                    for (int c = 0; c < 4; ++c) {
                        for (int o = 0; o < 4; ++o) {
                            const vec4 w = fromTexel(weights.texels[at + uint(o)]);
                            for (int p = 0; p < BLOCK; ++p) sums[p][o] += x[p + tap][c] * w;
                        }
                        at += line;
                    }
                }
            }
        }
    }
}

/// Returns the first pixel of this invocation.
ivec2 firstPixel() {
    return ivec2(params.region.left, params.region.top) + ivec2(gl_GlobalInvocationID.xy) * ivec2(BLOCK, 1);
}

bool inRegion(ivec2 pixel) {
    return pixel.x < params.region.left + params.region.width && pixel.y < params.region.top + params.region.height;
}
