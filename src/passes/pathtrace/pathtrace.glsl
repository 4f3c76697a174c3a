// A unidirectional path tracer: each vertex samples one light and one direction from the material, combined
// by multiple importance sampling (E. Veach, 1997). Depth D counts scattering events: D = 0 shows emitters
// only. Passages through glass have a separate limit; beyond it they count as bounces.
//
// The including shader sets SPLIT_LOBES: whether PathRadiance keeps its three parts separate. If not,
// everything is in `diffuse`, which saves a dozen registers for traversal.
#include "passes/pathtrace/pathtrace_params.h"
#include "shaders/material/lights.glsl"
#include "shaders/material/medium.glsl"
#include "shaders/common/reflection.glsl"

layout(set = 0, binding = 20, scalar) uniform Params {
    PathtraceParams params;
};

struct PathRadiance {
    vec3 emission;           // seen directly
    vec3 diffuse, specular;  // by lobe of the first surface; their sum is all scattered light
};

vec3 clampFirefly(vec3 radiance, uint depth) {
    const float l = luminance(radiance);
    return params.fireflyClamp > 0.0 && depth > 0u && l > params.fireflyClamp ? radiance * (params.fireflyClamp / l)
                                                                               : radiance;
}

// Width of a scattered ray's cone: this share of the solid angle that the ray represents, limited to a
// maximum. The lobe itself blurs its content. A much narrower cone costs noise; a wider one costs contrast at
// low sample counts.
const float LOBE_SHARE = 0.25, MAX_LOBE_SPREAD = 0.25, WITHOUT_JITTER = 4.0;

struct Path {
    Ray ray;
    vec3 throughput;
    vec3 diffuseShare;  // of the path's further light, per channel
    float bsdfPdf;      // of the current direction
    LightShares shares;  // at the vertex where it began: light that it hits could have been sampled from
                         // there
    bool delta;         // the direction can only be sampled by the BSDF
    float coneWidth;
    vec3 medium;  // absorption of the body around the path, per unit of length
    PathRadiance radiance;
    uint rays;
    uint primary;  // index of the vertex that the layers describe: 0, or 1 behind a mirror
    uint passages;  // through glass so far, at most params.maxTransmissionDepth
};

/// Adds the radiance that a path hits at vertex `depth`. At the primary vertex it belongs to the emission
/// layer.
void addEmission(inout Path path, vec3 radiance, float lightDensity, uint depth) {
    const float weight = path.delta ? 1.0 : powerHeuristic(path.bsdfPdf, lightDensity);
    const vec3 found = clampFirefly(path.throughput * radiance * weight, max(depth, 1u) - 1u);
    if (!SPLIT_LOBES) {
        path.radiance.diffuse += found;
    } else if (depth <= path.primary) {
        path.radiance.emission += found;
    } else {
        path.radiance.diffuse += found * path.diffuseShare;
        path.radiance.specular += found * (1.0 - path.diffuseShare);
    }
}

void addEnvironment(inout Path path, uint depth) {
    if (!HAS_ENVIRONMENT) return;
    const vec2 uv = latLongOf(path.ray.direction);
    addEmission(path, environmentRadiance(uv, params.scene), environmentLightPdf(uv, path.shares, params.scene), depth);
}

void addDirectLight(inout Path path, Surface surface, Bsdf bsdf, uint depth, inout uint rng) {
    const LightSample light = sampleLight(receiverAt(surface), params.scene, rng, path.shares);
    const BsdfValue value = evaluateBsdf(bsdf, light.direction);
    const float weight = light.delta ? 1.0 : powerHeuristic(light.pdf, value.pdf);
    vec3 incident = clampFirefly(path.throughput * light.radiance * (weight / max(light.pdf, 1e-30)), depth);
    if (HAS_VOLUME) {
        if (light.distance < INFINITE_DISTANCE) {
            incident *= exp(-light.distance * mediumTowards(path.medium, surface, light.direction));
        }
    }
    vec3 diffuse = incident * value.diffuse, specular = incident * value.specular;
    if (!SPLIT_LOBES) {
        diffuse += specular;
        specular = vec3(0.0);
    } else if (depth > path.primary) {
        const vec3 sum = diffuse + specular;
        diffuse = sum * path.diffuseShare;
        specular = sum - diffuse;
    }
    if (light.pdf > 0.0 && luminance(diffuse) + luminance(specular) > 0.0) {
        ++path.rays;
        if (!traceAny(shadowRay(leavingPoint(surface, light.direction), light), params.scene.rootNode, rng)) {
            path.radiance.diffuse += diffuse;
            path.radiance.specular += specular;
        }
    }
}

/// True for a passage through glass: into a transmitting body, out of it, through a pane, or an internal
/// reflection.
bool isPassage(Surface surface, Bsdf bsdf, vec3 direction) {
    if (!HAS_TRANSMISSION || !isTransmitting(bsdf)) return false;
    return !surface.front || dot(direction, surface.geometricNormal) < 0.0;
}

/// Samples the material and continues in that direction. Returns false if the path ends.
bool scatter(inout Path path, Surface surface, Bsdf bsdf, uint depth, inout uint rng) {
    const BsdfSample next = sampleBsdf(bsdf, rng);
    if (!next.valid) return false;
    const vec3 value = next.value.diffuse + next.value.specular;
    if (SPLIT_LOBES && depth == path.primary) path.diffuseShare = next.value.diffuse / max(value, vec3(1e-20));
    path.throughput *= value / next.value.pdf;
    path.bsdfPdf = next.value.pdf;
    path.delta = next.delta;
    if (depth >= params.rouletteDepth) {
        const float survival = min(max(path.throughput.x, max(path.throughput.y, path.throughput.z)), 0.95);
        if (random(rng) >= survival) return false;
        path.throughput /= survival;
    }
    if (isPassage(surface, bsdf, next.direction)) path.passages = min(path.passages + 1u, params.maxTransmissionDepth);
    if (HAS_VOLUME) path.medium = mediumTowards(path.medium, surface, next.direction);
    path.ray = Ray(leavingPoint(surface, next.direction), next.direction, INFINITE_DISTANCE);
    return path.throughput != vec3(0.0);
}

/// The surface that the layers describe: the camera ray's hit, or what a perfect mirror shows there; and the
/// motion of reflections.
struct FirstSight {
    FirstHit hit;
    float traveled;
    Mirror mirror;     // the camera ray's hit, once it has been scattered
    float reflection;  // reflectionShare() if the scattered ray follows a reflection
    bool reflects;     // the ray scattered at the primary vertex is reflected specularly
};

void missed(inout FirstSight sight, Path path, uint depth) {
    if (SPLIT_LOBES && depth == path.primary + 1u && sight.reflects) sight.hit.hitDistance = vec2(HIT_NOTHING, 1.0);
    if (depth != 1u) return;
    const FirstHit sky = noHit(path.ray.direction);
    if (path.primary == 1u) sight.hit = shownBy(sight.mirror, sky, path.throughput);
    if (sight.reflection > 0.0)
        sight.hit.reflectionMotion =
            reflectionMotionOf(sight.mirror, sky, sight.reflection, sight.hit, params.view);
}

void met(inout FirstSight sight, Path path, Hit hit, Surface surface, Bsdf bsdf, uint depth) {
    if (SPLIT_LOBES && depth == path.primary + 1u && sight.reflects) sight.hit.hitDistance = vec2(hit.t, 1.0);
    if (depth == path.primary) {
        PreviousPoint previous = PreviousPoint(surface.position, surface.normal);
        if (SPLIT_LOBES) previous = previousPoint(hit, surface, params.scene);
        sight.hit = firstHitOf(surface, bsdf, sight.traveled, previous);
        if (depth == 1u) sight.hit = shownBy(sight.mirror, sight.hit, path.throughput);
    } else if (depth == 1u && sight.reflection > 0.0) {
        FirstHit seen = noHit(path.ray.direction);
        seen.hit = true;
        seen.position = surface.position;
        seen.previous = previousPoint(hit, surface, params.scene);
        sight.hit.reflectionMotion =
            reflectionMotionOf(sight.mirror, seen, sight.reflection, sight.hit, params.view);
    }
}

/// Records the scattering at the primary vertex, or at a mirror before it.
void scattered(inout FirstSight sight, inout Path path, Hit hit, Surface surface, Bsdf bsdf, uint depth) {
    sight.reflects = luminance(path.diffuseShare) < 0.5 && dot(path.ray.direction, surface.geometricNormal) > 0.0;
    if (depth > 0u || !sight.reflects) return;
    const Shape shape = shapeAt(hit, surface);
    sight.mirror = Mirror(surface.position, surface.normal, sight.hit.previous, shape.curvature);
    if (params.throughMirrors != 0u && path.delta && isPerfectMirror(bsdf)) {
        path.primary = 1u;
    } else {
        sight.reflection = reflectionShare(surface, shape);
    }
}

/// Returns the spread of a scattered ray's cone: the previous spread plus the ray's share of the lobe. Each
/// of n rays of this density represents 1 / (n density) of solid angle. A sharp lobe is nearly a mirror.
/// Without jitter, which would average, the cone is wider, so that textures in reflections do not shimmer for
/// a denoiser.
float spreadAfter(Path path, float spread, float n) {
    if (path.delta) return spread;
    const float lobe = LOBE_SHARE * inversesqrt(max(path.bsdfPdf, 1e-20));
    const float widened = params.view.jitter == JITTER_OFF ? WITHOUT_JITTER : 1.0;
    return length(vec2(spread, widened * min(lobe, MAX_LOBE_SPREAD) * shareOfRay(n)));
}

PathRadiance tracePath(Ray ray, uint sampleIndex, inout uint rng, inout uint rays, out FirstHit first) {
    const Cone cone = pixelCone(params.view, sampleIndex);
    Path path = Path(ray, vec3(1.0), vec3(1.0), 0.0, LightShares(0.0, 0.0), true, cone.width, vec3(0.0),
                     PathRadiance(vec3(0.0), vec3(0.0), vec3(0.0)), 0u, 0u, 0u);
    const bool throughCentres = params.view.jitter == JITTER_OFF;
    float spread = cone.spread;
    FirstSight sight;
    sight.hit = noHit(ray.direction);
    sight.traveled = sight.reflection = 0.0;
    sight.reflects = false;
    uint culled = 0u;
    for (uint depth = 0u; depth <= params.maxDepth + path.passages; ++depth) {
        ++path.rays;
        const Hit hit = traceClosest(path.ray, params.scene.rootNode, rng);
        if (!isHit(hit)) {
            missed(sight, path, depth);
            addEnvironment(path, depth);
            break;
        }
        path.coneWidth += spread * hit.t;
        const vec3 toViewer = -path.ray.direction;
        const RayCone rayCone = RayCone(path.coneWidth, !path.delta, throughCentres);
        const Surface surface = loadSurface(hit.triangle, hit.instance, hit.barycentrics, toViewer, rayCone);
        // Nothing is absorbed on the way to the sky, since a ray that never leaves a body was not in one.
        if (HAS_VOLUME) path.throughput *= exp(-hit.t * mediumBefore(path.medium, surface));
        const Bsdf bsdf = makeBsdf(surface, toViewer);
        if (depth <= path.primary) sight.traveled += hit.t;
        if (depth == 0u && passesBack(surface, culled, path.ray.origin)) {
            --depth;
            continue;
        }
        met(sight, path, hit, surface, bsdf, depth);
        if (surface.emission != vec3(0.0)) {
            const float density =
                HAS_TRIANGLE_LIGHTS ? lightPdf(surface, hit.t, path.ray.direction, path.shares) : 0.0;
            addEmission(path, surface.emission, density, depth);
        }
        if (depth == params.maxDepth + path.passages || surface.unlit) break;
        addDirectLight(path, surface, bsdf, depth, rng);
        if (!scatter(path, surface, bsdf, depth, rng)) break;
        if (SPLIT_LOBES && depth <= path.primary) scattered(sight, path, hit, surface, bsdf, depth);
        if (HAS_TEXTURES) spread = spreadAfter(path, spread, rayNumber(params.view, sampleIndex));
    }
    first = sight.hit;
    rays += path.rays;
    return path.radiance;
}
