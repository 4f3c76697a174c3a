#version 460
#extension GL_EXT_scalar_block_layout : require
// The albedo back into the filtered light, and what the camera sees directly.
#include "denoise/methods/atrous/atrous_params.h"
#include "denoise/stages/guides.glsl"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    AtrousModulateParams params;
};
READ_HALF4(1, signal);
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D albedo;
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D emission;
layout(set = 0, binding = 4, rgba32f) uniform writeonly image2D beauty;

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    vec3 light = LOAD_HALF4(signal, at).rgb;
    if (params.demodulate != 0u) light *= modulation(imageLoad(albedo, at));
    imageStore(beauty, at, vec4(light + finiteOr(imageLoad(emission, at).rgb, vec3(0.0)), 1.0));
}
