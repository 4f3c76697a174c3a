// Whether light arrives at a point. Smooth panes let it through, straight on.
#ifndef LIMPID_SHADOW_GLSL
#define LIMPID_SHADOW_GLSL

#include "shaders/material/bsdf.glsl"
#include "shaders/material/lights.glsl"

const uint MAX_PANES = 8u;  // that light passes through on its way to a point

/// Returns the share of a sampled light that arrives at `start`: 0 behind anything but up to `panes` smooth panes. Adds
/// the number of rays that were traced.
vec3 arrivingShare(vec3 start, LightSample light, uint panes, SceneParams scene, uint rng, inout uint rays) {
    if (!HAS_PANES) {
        ++rays;
        return vec3(traceAny(shadowRay(start, light), scene.rootNode, rng) ? 0.0 : 1.0);
    }
    vec3 share = vec3(1.0);
    for (uint pane = 0u; pane <= panes; ++pane) {
        ++rays;
        const Ray ray = shadowRay(start, light);
        const Hit hit = traceClosest(ray, scene.rootNode, rng);
        if (!isHit(hit)) return share;
        if (!isThinGlass(hit.triangle, hit.instance)) break;
        const Surface surface =
            loadSurface(hit.triangle, hit.instance, hit.barycentrics, -ray.direction, RayCone(0.0, true, false));
        const Bsdf bsdf = makeBsdf(surface, -ray.direction);
        if (!isClearPane(bsdf)) break;
        share *= throughPane(bsdf);
        start = leavingPoint(surface, ray.direction);
    }
    return vec3(0.0);
}

#endif
