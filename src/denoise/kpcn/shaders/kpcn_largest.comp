#version 460
#extension GL_EXT_scalar_block_layout : require
// Writes the maximum of each 8x8 texels. Repeated until one texel is left.
#include "denoise/kpcn/kpcn_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    KpcnReduceParams params;
};
layout(set = 0, binding = 1, r32f) uniform readonly image2D source;
layout(set = 0, binding = 2, r32f) uniform writeonly image2D largest;

void main() {
    const ivec2 first = 8 * ivec2(gl_GlobalInvocationID.xy);
    if (first.x >= params.width || first.y >= params.height) return;
    const ivec2 end = min(first + 8, ivec2(params.width, params.height));
    float value = 0.0;
    for (int y = first.y; y < end.y; ++y) {
        for (int x = first.x; x < end.x; ++x) value = max(value, imageLoad(source, ivec2(x, y)).x);
    }
    imageStore(largest, first / 8, vec4(value));
}
