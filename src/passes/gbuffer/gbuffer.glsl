// Traces one primary ray per pixel: the first hit, and the direct light there. Used by every tracer.
//
// Rays, random numbers and surfaces are the same as in the path tracer's first sample, so that the layers are
// equal.
#include "passes/gbuffer/gbuffer_params.h"

layout(set = 0, binding = 20, scalar) uniform Params {
    GBufferParams params;
};

#define SOBOL_TABLE params.points
#include "shaders/common/first_hit.glsl"
#include "shaders/material/receiver.glsl"
#include "shaders/material/shadow.glsl"
#include "shaders/material/medium.glsl"

layout(constant_id = 21) const bool LIGHT = true;    // false: the layer `light` is black
layout(constant_id = 22) const bool SHADOWS = true;  // false: lights shine through everything

layout(set = 0, binding = 21, rgba32f) uniform writeonly image2D light;
layout(set = 0, binding = 22, rgba32f) uniform writeonly image2D emission;
layout(set = 0, binding = 23, rgba32f) uniform writeonly image2D albedo;
layout(set = 0, binding = 24, rgba32f) uniform writeonly image2D albedoSpecular;
layout(set = 0, binding = 25, rgba32f) uniform writeonly image2D normal;
layout(set = 0, binding = 26, rgba32f) uniform writeonly image2D depth;   // depth, 0 at a miss | hit
layout(set = 0, binding = 27, rgba32f) uniform writeonly image2D motion;  // a: valid
layout(set = 0, binding = 28, rgba32f) uniform writeonly image2D previousNormal;
layout(set = 0, binding = 29, rgba32f) uniform writeonly image2D position;         // a: magnitude, 0 at a
                                                                                   // miss
layout(set = 0, binding = 30, rgba32f) uniform writeonly image2D geometricNormal;
layout(set = 0, binding = 31, rg32ui) uniform writeonly uimage2D ids;              // instance | material
layout(set = 0, binding = 34, rgba32f) uniform writeonly image2D roughness;
layout(set = 0, binding = 32, rg32ui) uniform readonly uimage2D countersBefore;
layout(set = 0, binding = 33, rg32ui) uniform writeonly uimage2D counters;  // rays | rejected samples

/// The result of a primary ray.
struct Seen {
    FirstHit first;
    vec3 light, emission;
    vec3 geometricNormal;
    float magnitude;
    uint rays;
};

/// Samples one light. There is no BSDF sampling here, so the light counts in full; perfectly smooth lobes
/// show no light.
vec3 directLight(Surface surface, Bsdf bsdf, uint rng, inout uint rays) {
    SceneParams scene = params.scene;
    if (HAS_CLEARCOAT) {
        // A coat with a normal of its own also reflects sky that is below the base's horizon, where an even sky would
        // not be sampled.
        if (surface.clearcoat > 0.0 && surface.clearcoatNormal != surface.normal) scene.environmentIsEven = 0u;
    }
    LightShares shares;
    const LightSample drawn = sampleLight(litAt(surface), scene, rng, shares);
    const BsdfValue value = evaluateBsdf(bsdf, drawn.direction);
    vec3 scattered = drawn.radiance * (value.diffuse + value.specular) / max(drawn.pdf, 1e-30);
    if (HAS_VOLUME) {
        if (drawn.distance < INFINITE_DISTANCE) {
            scattered *= exp(-drawn.distance * mediumTowards(vec3(0.0), surface, drawn.direction));
        }
    }
    if (drawn.pdf <= 0.0 || luminance(scattered) <= 0.0) return vec3(0.0);
    if (SHADOWS) {
        const vec3 start = leavingPoint(surface, drawn.direction);
        scattered *= arrivingShare(start, drawn, MAX_PANES, params.scene, rng, rays);
    }
    return scattered;
}

Seen shade(Hit hit, Surface surface, float depth, vec3 toViewer, uint rng, uint rays) {
    const Bsdf bsdf = makeBsdf(surface, toViewer);
    Seen seen;
    seen.first = firstHitOf(surface, bsdf, depth, previousPoint(hit, surface, params.scene));
    seen.geometricNormal = surface.geometricNormal;
    seen.magnitude = surface.magnitude;
    seen.emission = surface.emission;
    seen.light = vec3(0.0);
    seen.rays = rays;
    if (LIGHT) {
        if (!surface.unlit) seen.light = directLight(surface, bsdf, rng, seen.rays);
    }
    if (HAS_VOLUME) {
        const vec3 throughput = exp(-hit.t * mediumBefore(vec3(0.0), surface));
        seen.emission *= throughput;
        seen.light *= throughput;
    }
    return seen;
}

Seen look(Ray ray, uint rng) {
    Seen seen = Seen(noHit(ray.direction), vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0u);
    const Cone cone = pixelCone(params.view, 0u);
    float coneWidth = cone.width, traveled = 0.0;
    uint culled = 0u, blended = 0u;
    Hit hit;
    Surface surface;
    bool passes;
    do {
        ++seen.rays;
        const bool stops = HAS_BLENDED && blended < MAX_WEAKENING;
        hit = traceClosest(ray, params.scene.rootNode, stops ? HIT_BLENDED : rng);
        if (!isHit(hit)) {
            if (HAS_ENVIRONMENT) seen.emission = environmentRadiance(latLongOf(ray.direction), params.scene);
            return seen;
        }
        coneWidth += cone.spread * hit.t;
        traveled += hit.t;
        const RayCone rayCone = RayCone(coneWidth, false, params.view.jitter == JITTER_OFF);
        surface = loadSurface(hit.triangle, hit.instance, hit.barycentrics, -ray.direction, rayCone);
        passes = false;
        if (stops) passes = passesBlended(hit.triangle, hit.instance, hit.barycentrics, blended, rng);
        if (passes) {
            ray.origin = leavingPoint(surface, ray.direction);
        } else {
            passes = passesBack(surface, culled, ray.origin);
        }
    } while (passes);
    return shade(hit, surface, traveled, -ray.direction, rng, seen.rays);
}

void tracePixel(uvec2 pixel) {
    const ivec2 at = ivec2(pixel);
    uint rng = startStream(pixel.y * params.view.width + pixel.x, params.view.stream, params.view.seed);
    startSample(pixel, 0u);
    const vec2 point = vec2(pixel) + subpixel(params.view, 0u, rng);
    Seen seen = look(cameraRay(params.view, point), rng);
    const bool rejected = !isFinite(seen.light + seen.emission);
    if (rejected) seen.light = seen.emission = vec3(0.0);
    const FirstHit first = seen.first;
    imageStore(light, at, vec4(seen.light, 0.0));
    imageStore(emission, at, vec4(seen.emission, 0.0));
    imageStore(albedo, at, vec4(first.albedo, 0.0));
    imageStore(albedoSpecular, at, vec4(first.albedoSpecular, 0.0));
    imageStore(normal, at, vec4(first.normal, 0.0));
    imageStore(depth, at, vec4(first.depth, first.hit ? 1.0 : 0.0, 0.0, 0.0));
    imageStore(motion, at, motionOf(first, params.view));
    imageStore(previousNormal, at, vec4(first.previous.normal, 0.0));
    imageStore(position, at, first.hit ? vec4(first.position, seen.magnitude) : vec4(0.0));
    imageStore(geometricNormal, at, vec4(seen.geometricNormal, 0.0));
    imageStore(roughness, at, vec4(first.roughness, 0.0, 0.0, 0.0));
    imageStore(ids, at, uvec4(first.ids, 0u, 0u));
    imageStore(counters, at, imageLoad(countersBefore, at) + uvec4(seen.rays, rejected ? 1u : 0u, 0u, 0u));
}
