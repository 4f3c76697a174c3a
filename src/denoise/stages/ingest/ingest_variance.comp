#version 460
#extension GL_EXT_scalar_block_layout : require
// Light of several samples with what filters read in its alpha: the mean squared deviation of the samples' luminance,
// which follows from the variance of their mean.
#include "denoise/stages/layer.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    uint width;
    uint height;
    float ofVariance;  // samples - 1
}
params;
READ_LAYER(1, lightIn);
READ_LAYER(2, varianceIn);
layout(set = 0, binding = 3, rgba32f) uniform writeonly image2D light;

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    const float variance = LOAD_LAYER(varianceIn, at).r;
    const bool known = variance > 0.0 && !isinf(variance);
    imageStore(light, at, vec4(LOAD_LAYER(lightIn, at).rgb, known ? params.ofVariance * variance : 0.0));
}
