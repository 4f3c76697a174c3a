// The path tracer with every layer of docs/layers.md: means and variances over this launch's samples. Used by
// every tracer. LIMPID_FOR_FILTERS: as filters read them (ForFilters in base/layers/layer_table.h).
const bool SPLIT_LOBES = true;
#include "passes/pathtrace/pathtrace.glsl"
#include "shaders/common/filter_image.glsl"

#ifdef LIMPID_FOR_FILTERS
#define HALVES rgba16f
#define ONE_HALF r16f
#define TO_HALVES(value) nearestHalf(clamp(value, vec4(-MAX_HALF), vec4(MAX_HALF)))
#else
#define HALVES rgba32f
#define ONE_HALF rgba32f
#define TO_HALVES(value) (value)
#endif

// rgb: mean; a: mean squared deviation (of luminance for colours) within this launch.
layout(set = 0, binding = 21, HALVES) uniform writeonly image2D diffuse;
layout(set = 0, binding = 22, HALVES) uniform writeonly image2D specular;
layout(set = 0, binding = 23, HALVES) uniform writeonly image2D emission;
layout(set = 0, binding = 24, HALVES) uniform writeonly image2D albedo;
layout(set = 0, binding = 25, HALVES) uniform writeonly image2D albedoSpecular;
layout(set = 0, binding = 26, HALVES) uniform writeonly image2D normal;
layout(set = 0, binding = 27, rgba32f) uniform writeonly image2D depth;   // depth of hits, 0 for misses |
                                                                          // hits | 0
layout(set = 0, binding = 28, HALVES) uniform writeonly image2D motion;  // sum over valid samples and their
                                                                          // number, both divided by the
                                                                          // number of samples
layout(set = 0, binding = 32, HALVES) uniform writeonly image2D previousNormal;
layout(set = 0, binding = 33, HALVES) uniform writeonly image2D reflectionMotion;  // likewise
layout(set = 0, binding = 34, ONE_HALF) uniform writeonly image2D roughness;
#ifndef LIMPID_FOR_FILTERS
layout(set = 0, binding = 35, rgba32f) uniform writeonly image2D hitDistance;  // sum over valid samples | their number
#endif
layout(set = 0, binding = 29, rg32ui) uniform writeonly uimage2D ids;     // instance | material, of the first sample
layout(set = 0, binding = 30, rg32ui) uniform readonly uimage2D countersBefore;
layout(set = 0, binding = 31, rg32ui) uniform writeonly uimage2D counters;  // rays | rejected samples

const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);

/// Updates the mean and the sum of squared deviations of dot(value, weights): B. P. Welford, Technometrics
/// 1962.
void accumulate(inout vec4 moments, vec3 value, vec3 weights, float count) {
    const vec3 before = value - moments.rgb;
    moments.rgb += before / count;
    moments.a += dot(before, weights) * dot(value - moments.rgb, weights);
}

/// Like accumulate(), but the deviation is averaged over the three components.
void accumulateVector(inout vec4 moments, vec3 value, float count) {
    const vec3 before = value - moments.rgb;
    moments.rgb += before / count;
    moments.a += dot(before, value - moments.rgb) / 3.0;
}

void tracePixel(uvec2 pixel) {
    const ivec2 at = ivec2(pixel);
    uint rng = startStream(pixel.y * params.view.width + pixel.x, params.view.stream, params.view.seed);
    uint rays = 0u, rejected = 0u;
    vec4 diffuseMoments = vec4(0.0), specularMoments = vec4(0.0), emissionMoments = vec4(0.0);
    vec4 albedoMoments = vec4(0.0), albedoSpecularMoments = vec4(0.0), normalMoments = vec4(0.0);
    vec4 depthMoments = vec4(0.0), motionSum = vec4(0.0), reflectionMotionSum = vec4(0.0);
    vec3 previousNormalSum = vec3(0.0);
    vec2 hitDistanceSum = vec2(0.0);
    float roughnessSum = 0.0;
    for (uint i = 0u; i < params.samples; ++i) {
        FirstHit first;
        startSample(pixel, i);
        const vec2 point = vec2(pixel) + subpixel(params.view, i, rng);
        PathRadiance path = tracePath(lensRay(params.view, point, rng), i, rng, rays, first);
        if (!isFinite(path.emission + path.diffuse + path.specular)) {
            path = PathRadiance(vec3(0.0), vec3(0.0), vec3(0.0));
            ++rejected;
        }
        const float count = float(i + 1u);
        accumulate(diffuseMoments, path.diffuse, LUMINANCE, count);
        accumulate(specularMoments, path.specular, LUMINANCE, count);
        accumulate(emissionMoments, path.emission, LUMINANCE, count);
        accumulate(albedoMoments, first.albedo, LUMINANCE, count);
        accumulate(albedoSpecularMoments, first.albedoSpecular, LUMINANCE, count);
        accumulateVector(normalMoments, first.normal, count);
        accumulate(depthMoments, vec3(first.depth, first.hit ? 1.0 : 0.0, 0.0), vec3(1.0, 0.0, 0.0), count);
        motionSum += motionOf(first, params.view);
        reflectionMotionSum += first.reflectionMotion;
        previousNormalSum += first.previous.normal;
        hitDistanceSum += first.hitDistance;
        roughnessSum += first.roughness;
        if (i == 0u) imageStore(ids, at, uvec4(first.ids, 0u, 0u));
    }
    const vec4 perSample = vec4(1.0, 1.0, 1.0, 1.0 / float(params.samples));
    imageStore(diffuse, at, TO_HALVES(diffuseMoments * perSample));
    imageStore(specular, at, TO_HALVES(specularMoments * perSample));
    imageStore(emission, at, TO_HALVES(emissionMoments * perSample));
    imageStore(albedo, at, TO_HALVES(albedoMoments * perSample));
    imageStore(albedoSpecular, at, TO_HALVES(albedoSpecularMoments * perSample));
    imageStore(normal, at, TO_HALVES(normalMoments * perSample));
    imageStore(depth, at, depthMoments * perSample);
    imageStore(motion, at, TO_HALVES(motionSum / float(params.samples)));
    imageStore(reflectionMotion, at, TO_HALVES(reflectionMotionSum / float(params.samples)));
    imageStore(previousNormal, at, TO_HALVES(vec4(previousNormalSum / float(params.samples), 0.0)));
    imageStore(roughness, at, TO_HALVES(vec4(roughnessSum / float(params.samples), 0.0, 0.0, 0.0)));
#ifndef LIMPID_FOR_FILTERS
    imageStore(hitDistance, at, vec4(hitDistanceSum / float(params.samples), 0.0, 0.0));
#endif
    imageStore(counters, at, imageLoad(countersBefore, at) + uvec4(rays, rejected, 0u, 0u));
}
