// The nearest and farthest first hits of several rays through each texel of the maps around punctual lights. Used by
// every tracer.
#include "passes/light_distances/light_distances_params.h"

layout(set = 0, binding = 20, scalar) uniform Params {
    LightDistancesParams params;
};

#include "shaders/common/distance_pair.glsl"
#include "shaders/trace/trace.glsl"

layout(set = 0, binding = 21, r32f) uniform writeonly imageBuffer lightFirstHits;

struct HitRange {
    float nearest, farthest;
};

HitRange firstHits(vec3 light, uvec2 texel, uint number) {
    HitRange range = HitRange(INFINITE_DISTANCE, 0.0);
    for (uint ray = 0u; ray < LIGHT_MAP_RAYS * LIGHT_MAP_RAYS; ++ray) {
        // Regular directions would meet edges exactly, where rays may slip through.
        uint state = tea(number, ray);
        const vec2 within = (vec2(ray % LIGHT_MAP_RAYS, ray / LIGHT_MAP_RAYS) + random2(state)) / float(LIGHT_MAP_RAYS);
        const vec2 place = (vec2(texel) + within) / float(LIGHT_MAP_SIZE);
        const vec3 direction = fromOctahedral(2.0 * place - 1.0, 1.0);
        // Each ray decides anew on partly transparent surfaces.
        const Hit hit = traceClosest(Ray(light, direction, INFINITE_DISTANCE), params.scene.rootNode, state);
        // Light goes on through panes. How far is not worth another ray.
        float distance = hit.t;
        if (HAS_PANES) {
            if (isHit(hit) && isThinGlass(hit.triangle, hit.instance)) distance = INFINITE_DISTANCE;
        }
        range.nearest = min(range.nearest, distance);
        range.farthest = max(range.farthest, distance);
    }
    return range;
}

/// The maps are below each other.
void traceTexel(uvec2 place) {
    const uint number = place.y * LIGHT_MAP_SIZE + place.x;
    const int at = int((params.scene.triangleLightCount + place.y / LIGHT_MAP_SIZE) * LIGHT_TEXELS);
    const uvec4 head = imageLoad(lights, at);
    HitRange range = HitRange(INFINITE_DISTANCE, INFINITE_DISTANCE);
    if ((head.w & LIGHT_KIND_MASK) != LIGHT_DIRECTIONAL)
        range = firstHits(uintBitsToFloat(head.xyz), uvec2(place.x, place.y % LIGHT_MAP_SIZE), number);
    imageStore(lightFirstHits, int(number), vec4(packDistances(range.nearest, range.farthest)));
}
