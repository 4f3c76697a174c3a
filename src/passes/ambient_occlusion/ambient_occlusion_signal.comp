#version 460
#extension GL_EXT_scalar_block_layout : require
// Converts ambient occlusion to the light that denoisers expect: the diffuse light of white surfaces. Where
// the ray misses, the sky is seen directly as emission.
#include "passes/ambient_occlusion/ambient_occlusion_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    AmbientOcclusionSignalParams params;
};
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D openness;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D depth;  // y: 1 at a hit
layout(set = 0, binding = 3, rgba32f) uniform writeonly image2D diffuse;
layout(set = 0, binding = 4, rgba32f) uniform writeonly image2D specular;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D emission;
layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D albedo;
layout(set = 0, binding = 7, rgba32f) uniform writeonly image2D albedoSpecular;
layout(set = 0, binding = 8, rgba32f) uniform writeonly image2D reflectionMotion;
layout(set = 0, binding = 9, rgba32f) uniform writeonly image2D hitDistance;

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    const vec3 open = imageLoad(openness, at).rgb;
    const float hit = imageLoad(depth, at).y;
    imageStore(diffuse, at, vec4(hit * open, 0.0));
    imageStore(emission, at, vec4((1.0 - hit) * open, 0.0));
    imageStore(albedo, at, vec4(vec3(hit), 0.0));
    imageStore(specular, at, vec4(0.0));
    imageStore(albedoSpecular, at, vec4(0.0));
    imageStore(reflectionMotion, at, vec4(0.0));
    imageStore(hitDistance, at, vec4(0.0));
}
