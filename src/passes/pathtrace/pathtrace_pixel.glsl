// Only the beauty: the fast path of `--integrator path`. Used by every tracer.
const bool SPLIT_LOBES = false;
#include "passes/pathtrace/pathtrace.glsl"

layout(set = 0, binding = 21, rgba32f) uniform writeonly image2D beauty;  // mean of this launch's samples; a:
                                                                          // the share that hit a surface
layout(set = 0, binding = 22, rg32ui) uniform readonly uimage2D countersBefore;
layout(set = 0, binding = 23, rg32ui) uniform writeonly uimage2D counters;  // rays | rejected samples

void tracePixel(uvec2 pixel) {
    uint rng = startStream(pixel.y * params.view.width + pixel.x, params.view.stream, params.view.seed);
    uint rays = 0u, rejected = 0u;
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < params.samples; ++i) {
        FirstHit first;
        startSample(pixel, i);
        const vec2 point = vec2(pixel) + subpixel(params.view, i, rng);
        const PathRadiance path = tracePath(lensRay(params.view, point, rng), i, rng, rays, first);
        const vec3 radiance = path.diffuse;
        if (isFinite(radiance)) {
            sum.rgb += radiance;
        } else {
            ++rejected;
        }
        sum.a += first.hit ? 1.0 : 0.0;
    }
    imageStore(beauty, ivec2(pixel), sum / float(params.samples));
    imageStore(counters, ivec2(pixel), imageLoad(countersBefore, ivec2(pixel)) + uvec4(rays, rejected, 0u, 0u));
}
