// Traces rays: the nearest hit, and whether there is any.
#include "shaders/trace/trace.glsl"

struct TestRay {
    vec3 origin;
    vec3 direction;
    float tMax;
};
struct TestHit {
    float t;  // negative: no hit
    vec2 barycentrics;
    uint instance, primitive, any;
};

layout(set = 0, binding = 20, scalar) uniform Params {
    uint rootNode, count, seed;
} params;
layout(set = 0, binding = 21, scalar) readonly buffer Rays {
    TestRay values[];
} rays;
layout(set = 0, binding = 22, scalar) writeonly buffer Results {
    TestHit values[];
} results;

void traceRayNumber(uint i) {
    const TestRay r = rays.values[i];
    const Ray ray = Ray(r.origin, r.direction, r.tMax);
    uint rng = startStream(i, 0u, params.seed);
    const Hit hit = traceClosest(ray, params.rootNode, rng);
    TestHit result = TestHit(-1.0, vec2(0.0), NONE, NONE, 0u);
    if (isHit(hit)) {
        const TriangleIds ids = loadTriangleIds(hit.triangle, hit.instance);
        result = TestHit(hit.t, hit.barycentrics, ids.instance, ids.primitive, 0u);
    }
    result.any = traceAny(ray, params.rootNode, rng) ? 1u : 0u;
    results.values[i] = result;
}
