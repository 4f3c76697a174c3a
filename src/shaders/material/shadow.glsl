// How much of a light arrives at a point. Smooth panes and blended surfaces let it through, straight on.
#ifndef LIMPID_SHADOW_GLSL
#define LIMPID_SHADOW_GLSL

#include "shaders/material/bsdf.glsl"
#include "shaders/material/lights.glsl"

const uint MAX_PANES = 8u;  // that light passes through on its way to a point
/// Blended surfaces that weaken the light on its way to a point. At those behind them chance decides, as for other
/// rays, whether light passes.
const uint MAX_WEAKENING = 8u;

/// The share of light that goes straight through a pane; 0 if it is rough.
vec3 throughThinGlass(Surface surface, vec3 toViewer) {
    const Bsdf bsdf = makeBsdf(surface, toViewer);
    return isClearPane(bsdf) ? throughPane(bsdf) : vec3(0.0);
}

/// Returns the share of a sampled light that arrives at `start`: 0 behind anything but blended surfaces and up to
/// `panes` smooth panes. Adds the number of rays that were traced.
vec3 arrivingShare(vec3 start, LightSample light, uint panes, SceneParams scene, uint rng, inout uint rays) {
    if (!HAS_PANES && !HAS_BLENDED) {
        ++rays;
        return vec3(traceAny(shadowRay(start, light), scene.rootNode, rng) ? 0.0 : 1.0);
    }
    vec3 share = vec3(1.0);
    uint weakening = HAS_BLENDED ? MAX_WEAKENING : 0u;
    while (share != vec3(0.0)) {
        ++rays;
        const Ray ray = shadowRay(start, light);
        const Hit hit = traceClosest(ray, scene.rootNode, weakening > 0u ? HIT_BLENDED : rng);
        if (!isHit(hit)) break;
        float coverage = 1.0;
        if (weakening > 0u) {
            bool blended;
            coverage = coverageAt(hit.triangle, hit.instance, hit.barycentrics, blended);
            weakening -= blended ? 1u : 0u;
        }
        const bool pane = HAS_PANES && panes > 0u && isThinGlass(hit.triangle, hit.instance);
        if (coverage == 1.0 && !pane) return vec3(0.0);
        panes -= pane ? 1u : 0u;
        const Surface surface =
            loadSurface(hit.triangle, hit.instance, hit.barycentrics, -ray.direction, RayCone(0.0, true, false));
        share *= 1.0 - coverage + (pane ? coverage * throughThinGlass(surface, -ray.direction) : vec3(0.0));
        start = leavingPoint(surface, ray.direction);
    }
    return share;
}

#endif
