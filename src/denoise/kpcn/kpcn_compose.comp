#version 460
#extension GL_EXT_scalar_block_layout : require
// Both sides back to radiance, and what the camera sees directly.
#include "denoise/guides.glsl"
#include "denoise/kpcn/kpcn_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    KpcnComposeParams params;
};
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D diffuse;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D specular;
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D albedo;
layout(set = 0, binding = 4, rgba32f) uniform readonly image2D emission;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D beauty;

const float EPSILON = 0.00316;

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= params.width || at.y >= params.height) return;
    const vec3 surface = clamp(finiteOr(imageLoad(albedo, at).rgb, vec3(0.0)), 0.0, MAX_ALBEDO) + EPSILON;
    const vec3 scattered = imageLoad(diffuse, at).rgb * surface + exp(imageLoad(specular, at).rgb) - 1.0;
    imageStore(beauty, at, vec4(scattered + finiteOr(imageLoad(emission, at).rgb, vec3(0.0)), 1.0));
}
