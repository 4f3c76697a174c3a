#version 460
#extension GL_EXT_scalar_block_layout : require
// The picture from scattered light and what the camera sees directly.
#include "denoise/stages/compose/compose_params.h"
#include "denoise/stages/guides.glsl"
#include "denoise/methods/temporal/temporal_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    ComposeParams params;
};
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D scattered;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D emission;
layout(set = 0, binding = 3, r32ui) uniform readonly uimage2D disocclusion;
layout(set = 0, binding = 4, rgba32f) uniform writeonly image2D beauty;

vec3 colorOf(uint failure, vec3 tracked) {
    const vec3 colors[4] = vec3[4](tracked, vec3(0.0, 0.0, 1.0), vec3(1.0, 1.0, 0.0), vec3(1.0, 0.0, 0.0));
    return colors[failure & DISOCCLUSION_MASK];
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    const vec3 light = imageLoad(scattered, at).rgb + finiteOr(imageLoad(emission, at).rgb, vec3(0.0));
    const uint failure = imageLoad(disocclusion, at).x;
    imageStore(beauty, at, vec4(params.showDisocclusion != 0u ? colorOf(failure, vec3(luminance(light))) : light, 1.0));
}
