#version 460
#extension GL_EXT_scalar_block_layout : require
// The beauty alone: the fast path of `--pipeline path`.
const bool SPLIT_LOBES = false;
#include "passes/pathtrace/pathtrace.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 21, rgba32f) uniform writeonly image2D beauty;  // mean of this launch's samples
layout(set = 0, binding = 22, rg32ui) uniform readonly uimage2D countersBefore;
layout(set = 0, binding = 23, rg32ui) uniform writeonly uimage2D counters;  // rays | rejected samples

void main() {
    const uvec2 pixel = pixelOfInvocation(gl_WorkGroupID.xy, gl_LocalInvocationIndex);
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    uint rng = startStream(pixel.y * params.width + pixel.x, params.stream, params.seed);
    uint rays = 0u, rejected = 0u;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < params.samples; ++i) {
        FirstHit first;
        const vec2 point = vec2(pixel) + subpixel(i, rng);
        const PathRadiance path = tracePath(cameraRay(point), rng, rays, first);
        const vec3 radiance = path.diffuse;
        if (isFinite(radiance)) {
            sum += radiance;
        } else {
            ++rejected;
        }
    }
    imageStore(beauty, ivec2(pixel), vec4(sum / float(params.samples), 0.0));
    imageStore(counters, ivec2(pixel), imageLoad(countersBefore, ivec2(pixel)) + uvec4(rays, rejected, 0u, 0u));
}
