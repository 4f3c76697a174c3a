// The share of cosine-weighted rays around the shading normal that hit nothing within their length: S.
// Zhukov, A. Iones, G. Kronin, "An ambient light illumination model", 1998, but with every obstacle counting
// fully. With unlimited length it equals a white surface's reflection of a white sky. Used by every tracer.
#include "passes/ambient_occlusion/ambient_occlusion_params.h"

layout(set = 0, binding = 20, scalar) uniform Params {
    AmbientOcclusionParams params;
};

#define SOBOL_TABLE params.points
#include "shaders/trace/trace.glsl"

layout(set = 0, binding = 21, rgba32f) uniform readonly image2D position;  // a: magnitude, 0 at a miss
layout(set = 0, binding = 22, rgba32f) uniform readonly image2D geometricNormal;
layout(set = 0, binding = 23, rgba32f) uniform readonly image2D normal;
layout(set = 0, binding = 24, rgba32f) uniform readonly image2D before;  // result of earlier dispatches, if
                                                                         // there are any
layout(set = 0, binding = 25, rgba32f) uniform writeonly image2D openness;

/// A direction around the shading normal that points into the surface counts as occluded: no light arrives
/// from there.
bool isOpen(vec4 place, vec3 faceNormal, vec3 direction, uint rng) {
    bool open = dot(direction, faceNormal) > 0.0;
    if (open) {
        const Ray ray = Ray(offsetRay(place.xyz, faceNormal, place.w), direction, params.reach);
        open = !traceAny(ray, params.scene.rootNode, rng);
    }
    return open;
}

void tracePixel(uvec2 pixel) {
    const ivec2 at = ivec2(pixel);
    const vec4 place = imageLoad(position, at);
    const vec3 faceNormal = imageLoad(geometricNormal, at).xyz;
    const mat3 frame = frameAround(imageLoad(normal, at).xyz);
    uint rng = startStream(pixel.y * params.width + pixel.x, params.stream, params.seed);
    rng = tea(rng, OCCLUSION_STREAMS + params.firstRay);
    float open = params.firstRay > 0u ? imageLoad(before, at).x : 0.0;
    for (uint i = 0u; i < params.rays; ++i) {
        startSample(pixel, i);
        const vec3 direction = frame * sampleCosineHemisphere(stratified2(rng));
        // Each ray decides anew what partly transparent surfaces it passes.
        if (isOpen(place, faceNormal, direction, tea(rng, i))) open += 1.0;
    }
    imageStore(openness, at, vec4(vec3(place.w > 0.0 ? open / params.divisor : 1.0), 0.0));
}
