#version 460
#extension GL_EXT_scalar_block_layout : require
// Samples lights. Also traces a ray in the sampled direction, and returns the density with which its hit
// would have been sampled.
#include "lights_test.glsl"

struct DrawnLight {
    vec3 direction;
    float distance;
    vec3 radiance;
    float pdf;
    uint delta;
    float hitDistance, hitPdf;  // hitDistance is negative for a miss
};

layout(set = 0, binding = 21, scalar) writeonly buffer Results {
    DrawnLight values[];
} results;

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count) return;
    uint rng = startStream(i, 0u, params.seed);
    // A zero normal has no sides: light from all directions counts.
    LightShares shares;
    const Receiver receiver =
        Receiver(params.from, params.normal, params.normal, dot(params.normal, params.normal) == 0.0, 0.0);
    const LightSample light = sampleLight(receiver, params.scene, rng, shares);
    DrawnLight drawn = DrawnLight(light.direction, light.distance, light.radiance, light.pdf, light.delta ? 1u : 0u, -1.0, 0.0);
    if (!light.delta && light.pdf > 0.0) {
        const Hit hit = traceClosest(Ray(params.from, light.direction, INFINITE_DISTANCE), params.scene.rootNode, rng);
        if (isHit(hit)) {
            const Surface s = loadSurface(hit.triangle, hit.instance, hit.barycentrics, -light.direction, RayCone(0.0, false, false));
            drawn.hitDistance = hit.t;
            drawn.hitPdf = lightPdf(s, hit.t, light.direction, shares, params.scene);
        } else if (HAS_ENVIRONMENT) {
            drawn.hitPdf = environmentLightPdf(light.direction, latLongOf(light.direction), shares, params.scene);
        }
    }
    results.values[i] = drawn;
}
