// A unidirectional path tracer: each vertex samples one light and one direction from the material, combined
// by multiple importance sampling (E. Veach, 1997). Depth D counts scattering events: D = 0 shows emitters
// only. Passages through glass have a separate limit; beyond it they count as bounces.
//
// The including shader sets SPLIT_LOBES: whether PathRadiance keeps its three parts separate. If not,
// everything is in `diffuse`, which saves a dozen registers for traversal.
#include "passes/pathtrace/first_sight.glsl"

vec3 clampFirefly(vec3 radiance, uint depth) {
    const float l = luminance(radiance);
    return params.fireflyClamp > 0.0 && depth > 0u && l > params.fireflyClamp ? radiance * (params.fireflyClamp / l)
                                                                               : radiance;
}

// Width of a scattered ray's cone: this share of the solid angle that the ray represents, limited to a
// maximum. The lobe itself blurs its content. A much narrower cone costs noise; a wider one costs contrast at
// low sample counts.
const float LOBE_SHARE = 0.25, MAX_LOBE_SPREAD = 0.25, WITHOUT_JITTER = 4.0;

/// Adds the radiance that a path hits at vertex `depth`. At the primary vertex, and where the first glass reflects it,
/// it belongs to the emission layer.
void addEmission(inout Path path, vec3 radiance, float lightDensity, uint depth) {
    const float weight = path.delta ? 1.0 : powerHeuristic(path.bsdfPdf, lightDensity);
    const vec3 found = clampFirefly(path.throughput * radiance * weight, max(depth, 1u) - 1u);
    if (!SPLIT_LOBES) {
        path.radiance.diffuse += found;
    } else if (depth <= path.primary || depth == path.reflected) {
        path.radiance.emission += found;
    } else {
        path.radiance.diffuse += found * path.diffuseShare;
        path.radiance.specular += found * (1.0 - path.diffuseShare);
    }
}

void addEnvironment(inout Path path, uint depth) {
    if (!HAS_ENVIRONMENT) return;
    const vec2 uv = latLongOf(path.ray.direction);
    const float density = environmentLightPdf(path.ray.direction, uv, path.shares, params.scene);
    addEmission(path, environmentRadiance(uv, params.scene), density, depth);
}

/// Light from glass that the layers see through is specular.
void addDirectLight(inout Path path, Surface surface, Bsdf bsdf, bool seesThrough, uint depth, inout uint rng) {
    const LightSample light = sampleLight(litAt(surface), params.scene, rng, path.shares);
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
    } else if (depth > path.primary || seesThrough) {
        const vec3 sum = diffuse + specular;
        diffuse = seesThrough ? vec3(0.0) : sum * path.diffuseShare;
        specular = sum - diffuse;
    }
    if (light.pdf > 0.0 && luminance(diffuse) + luminance(specular) > 0.0) {
        const uint panes = min(MAX_PANES, params.maxTransmissionDepth - path.passages);
        const vec3 start = leavingPoint(surface, light.direction);
        const vec3 share = arrivingShare(start, light, panes, params.scene, rng, path.rays);
        path.radiance.diffuse += diffuse * share;
        path.radiance.specular += specular * share;
    }
}

/// True if the path may cross the surface after its last bounce, as light that next-event estimation samples does.
bool canPass(Path path, Bsdf bsdf) {
    return HAS_TRANSMISSION && isClearPane(bsdf) && path.passages < params.maxTransmissionDepth;
}

/// True if the path goes straight on through a pane, as the light that next-event estimation samples does. Then light
/// beyond the pane is weighted as that of the vertex where the path got its direction.
bool crossesPane(Path path, Surface surface, Bsdf bsdf, BsdfSample next) {
    return HAS_PANES && next.delta && path.panes < MAX_PANES && isClearPane(bsdf) &&
           dot(next.direction, path.ray.direction) > 0.999 &&
           passagesAfter(path, surface, bsdf, next.direction) > path.passages;
}

/// Samples the material and continues in that direction. Returns false if the path ends.
bool scatter(inout Path path, inout Branches branches, Surface surface, Bsdf bsdf, bool seesThrough, uint depth,
             inout uint rng) {
    BsdfSample next;
    if (seesThrough && isClearGlass(bsdf)) {
        next = throughGlass(path, branches, surface, bsdf, depth, rng);
    } else {
        next = sampleBsdf(bsdf, rng);
    }
    if (!next.valid) return false;
    const vec3 value = next.value.diffuse + next.value.specular;
    if (SPLIT_LOBES && depth == path.primary) path.diffuseShare = next.value.diffuse / max(value, vec3(1e-20));
    path.throughput *= value / next.value.pdf;
    if (crossesPane(path, surface, bsdf, next)) {
        ++path.panes;
    } else {
        path.panes = 0u;
        path.bsdfPdf = next.value.pdf;
        path.delta = next.delta;
    }
    if ((depth >= params.rouletteDepth || path.further) && !seesThrough) {
        const float survival = min(max(path.throughput.x, max(path.throughput.y, path.throughput.z)), 0.95);
        if (random(rng) >= survival) return false;
        path.throughput /= survival;
    }
    path.passages = passagesAfter(path, surface, bsdf, next.direction);
    if (HAS_VOLUME) path.medium = mediumTowards(path.medium, surface, next.direction);
    path.ray = Ray(leavingPoint(surface, next.direction), next.direction, INFINITE_DISTANCE);
    return path.throughput != vec3(0.0);
}

/// Returns the spread of a scattered ray's cone: the previous spread plus the ray's share of the lobe. Each
/// of n rays of this density represents 1 / (n density) of solid angle. A sharp lobe is nearly a mirror.
/// Without jitter, which would average, the cone is wider, so that textures in reflections do not shimmer for
/// a denoiser.
float spreadAfter(Path path, float spread, float n) {
    if (path.delta || path.panes > 0u) return spread;
    const float lobe = LOBE_SHARE * inversesqrt(max(path.bsdfPdf, 1e-20));
    const float widened = params.view.jitter == JITTER_OFF ? WITHOUT_JITTER : 1.0;
    return length(vec2(spread, widened * min(lobe, MAX_LOBE_SPREAD) * shareOfRay(n)));
}

/// Moves the path behind a partly transparent surface that it passes.
void goBehind(inout Path path, inout FirstSight sight, Hit hit, float spread, uint depth) {
    const vec3 direction = path.ray.direction;
    path.coneWidth += spread * hit.t;
    path.straight += hit.t;
    if (depth <= path.primary) sight.traveled += hit.t;
    if (SPLIT_LOBES && HAS_TRANSMISSION && depth > 0u && depth == path.primary) travel(sight.lens, hit.t);
    if (HAS_VOLUME) path.throughput *= exp(-hit.t * path.medium);
    const Surface surface =
        loadSurface(hit.triangle, hit.instance, hit.barycentrics, -direction, RayCone(0.0, true, false));
    path.ray.origin = leavingPoint(surface, direction);
}

/// Traces the path's ray to vertex `depth` and scatters it there. Returns false if the path ends.
bool nextVertex(inout Path path, inout Branches branches, inout FirstSight sight, inout float spread, inout uint depth,
                inout uint culled, uint sampleIndex, inout uint rng) {
    ++path.rays;
    const bool stops = HAS_BLENDED && path.blended < MAX_WEAKENING;
    const Hit hit = traceClosest(path.ray, params.scene.rootNode, stops ? HIT_BLENDED : rng);
    if (stops && isHit(hit)) {
        if (passesBlended(hit.triangle, hit.instance, hit.barycentrics, path.blended, rng)) {
            goBehind(path, sight, hit, spread, depth);
            return true;
        }
    }
    if (!isHit(hit)) {
        missed(sight, path, depth);
        addEnvironment(path, depth);
        return false;
    }
    path.coneWidth += spread * hit.t;
    const vec3 toViewer = -path.ray.direction;
    const RayCone rayCone = RayCone(path.coneWidth, !path.delta, params.view.jitter == JITTER_OFF);
    Surface surface = loadSurface(hit.triangle, hit.instance, hit.barycentrics, toViewer, rayCone);
    // Nothing is absorbed on the way to the sky, since a ray that never leaves a body was not in one.
    if (HAS_VOLUME) path.throughput *= exp(-hit.t * mediumBefore(path.medium, surface));
    if (HAS_DISPERSION) disperse(path, surface, rng);
    const Bsdf bsdf = makeBsdf(surface, toViewer);
    if (depth <= path.primary) sight.traveled += hit.t;
    if (depth == 0u && passesBack(surface, culled, path.ray.origin)) return true;
    met(sight, path, hit, surface, bsdf, depth);
    const float straight = path.straight + hit.t;
    if (surface.emission != vec3(0.0)) {
        const float density =
            HAS_TRIANGLE_LIGHTS ? lightPdf(surface, straight, path.ray.direction, path.shares, params.scene) : 0.0;
        addEmission(path, surface.emission, density, depth);
    }
    const bool last = depth == params.maxDepth + path.passages;
    if (surface.unlit || (last && !canPass(path, bsdf))) return false;
    const bool seesThrough = isSeenThrough(path, bsdf, depth);
    const LightShares shares = path.shares;
    if (!last) addDirectLight(path, surface, bsdf, seesThrough, depth, rng);
    if (!scatter(path, branches, surface, bsdf, seesThrough, depth, rng)) return false;
    if (last && path.panes == 0u) path.delta = true;  // no light was sampled here that a hit would share its weight with
    if (HAS_PANES || HAS_BLENDED) {
        const bool crossed = HAS_PANES && path.panes > 0u;
        if (crossed) path.shares = shares;
        path.straight = crossed ? straight : 0.0;
    }
    if (SPLIT_LOBES && depth <= path.primary) scattered(sight, path, hit, surface, bsdf, seesThrough, depth);
    if (HAS_TEXTURES) spread = spreadAfter(path, spread, rayNumber(params.view, sampleIndex));
    ++depth;
    return depth <= params.maxDepth + path.passages;
}

PathRadiance tracePath(Ray ray, uint sampleIndex, inout uint rng, inout uint rays, out FirstHit first) {
    const Cone cone = pixelCone(params.view, sampleIndex);
    Path path = Path(ray, vec3(1.0), vec3(1.0), 0.0, noLightShares(), true, cone.width, vec3(0.0),
                     PathRadiance(vec3(0.0), vec3(0.0), vec3(0.0)), 0u, 0u, 0u, false, false, 0u, 0u, 0u, 0.0,
                     ALL_CHANNELS);
    float spread = cone.spread;
    FirstSight sight;
    sight.hit = noHit(ray.direction);
    sight.traveled = sight.reflection = 0.0;
    sight.reflects = false;
    sight.lens = NO_LENS;
    Branches branches;
    branches.first.weight = branches.rest.weight = 0.0;
    float otherLobes = 0.0;
    uint culled = 0u, depth = 0u;
    while (true) {
        if (nextVertex(path, branches, sight, spread, depth, culled, sampleIndex, rng)) continue;
        if (!SPLIT_LOBES || !HAS_TRANSMISSION) break;
        const float weight = takeBranches(path, branches, depth);
        if (weight == 0.0) break;
        otherLobes += weight;
        sight.reflects = false;
        spread = spreadAfter(path, cone.spread, rayNumber(params.view, sampleIndex));
    }
    first = sight.hit;
    first.albedoSpecular += otherLobes;
    rays += path.rays;
    return path.radiance;
}
