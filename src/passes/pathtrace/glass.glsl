// Smooth glass that the layers see through: the path follows the brighter of its two smooth lobes, whole, and the other
// lobes start further paths.
#ifndef LIMPID_PATHTRACE_GLASS_GLSL
#define LIMPID_PATHTRACE_GLASS_GLSL

#include "passes/pathtrace/path.glsl"
#include "shaders/material/bsdf.glsl"
#include "shaders/material/medium.glsl"

/// The start of a path for light that glass does not send where the layers look.
struct Branch {
    Ray ray;
    vec3 throughput, medium;
    float coneWidth, bsdfPdf;
    bool delta;
    LightShares shares;
    uint depth, passages;
    uint channel;
    float weight;  // sum of the weights of all lobes; 0: none
};

/// One path for the other smooth lobe of the first glass, mostly its reflection, and one for all other lobes of the
/// glasses on the way, chosen by its weight. What the first one meets is seen in every frame, so lamps and sky in it
/// are as sharp, and as free of noise, as seen directly.
struct Branches {
    Branch first, rest;
};

/// KHR_materials_dispersion: from the first glass on whose index depends on the wavelength, a path carries one colour
/// channel, chosen at random. The indices of red, green and blue are the extension's.
void disperse(inout Path path, inout Surface surface, inout uint rng) {
    if (surface.dispersion <= 0.0 || surface.thin || surface.transmission <= 0.0) return;
    if (path.channel == ALL_CHANNELS) {
        path.channel = min(uint(3.0 * random(rng)), 2u);
        path.throughput *= 3.0 * vec3(equal(uvec3(path.channel), uvec3(0u, 1u, 2u)));
    }
    const float halfSpread = (surface.ior - 1.0) * 0.025 * surface.dispersion;
    surface.ior = max(surface.ior + (float(path.channel) - 1.0) * halfSpread, 1.0);
}

const uint MAX_SEEN_THROUGH = 8u;  // surfaces of glass

/// True for a passage through glass: into a transmitting body, out of it, through a pane, or an internal
/// reflection.
bool isPassage(Surface surface, Bsdf bsdf, vec3 direction) {
    if (!HAS_TRANSMISSION || !isTransmitting(bsdf)) return false;
    return !surface.front || dot(direction, surface.geometricNormal) < 0.0;
}

uint passagesAfter(Path path, Surface surface, Bsdf bsdf, vec3 direction) {
    if (!isPassage(surface, bsdf, direction)) return path.passages;
    return min(path.passages + 1u, params.maxTransmissionDepth);
}

/// Gives the lobe (whole: its value is f cos / pdf) a chance, by its weight among all that were offered, to be the
/// second path.
void offer(inout Branch branch, Path path, Surface surface, Bsdf bsdf, BsdfSample lobe, uint depth, inout uint rng) {
    const vec3 throughput = path.throughput * (lobe.value.diffuse + lobe.value.specular);
    const float weight = max(throughput.x, max(throughput.y, throughput.z));
    if (!lobe.valid || weight <= 0.0) return;
    branch.weight += weight;
    if (random(rng) * branch.weight > weight) return;
    branch.ray = Ray(leavingPoint(surface, lobe.direction), lobe.direction, INFINITE_DISTANCE);
    branch.throughput = throughput / weight;
    branch.depth = depth + 1u;
    branch.passages = passagesAfter(path, surface, bsdf, lobe.direction);
    branch.medium = HAS_VOLUME ? mediumTowards(path.medium, surface, lobe.direction) : vec3(0.0);
    branch.coneWidth = path.coneWidth;
    branch.bsdfPdf = lobe.value.pdf;
    branch.delta = lobe.delta;
    branch.channel = path.channel;
    branch.shares = path.shares;
}

/// True for glass, and a mirror behind it, if the layers describe what it shows. Glass that is seen in a mirror is a
/// surface.
bool isSeenThrough(Path path, Bsdf bsdf, uint depth) {
    if (!SPLIT_LOBES || !HAS_TRANSMISSION) return false;
    if (params.throughGlass == 0u || depth != path.primary || path.mirrored || depth >= MAX_SEEN_THROUGH) return false;
    return isClearGlass(bsdf) || (depth > 0u && params.throughMirrors != 0u && isPerfectMirror(bsdf));
}

/// Follows the brighter of the two smooth lobes of glass, whole; the others go to `branches`.
BsdfSample throughGlass(Path path, inout Branches branches, Surface surface, Bsdf bsdf, uint depth, inout uint rng) {
    const BsdfSample transmitted = clearGlassLobe(bsdf, true), reflected = clearGlassLobe(bsdf, false);
    const bool transmits = transmitted.valid &&
                           luminance(transmitted.value.specular) >= luminance(reflected.value.specular);
    BsdfSample followed = reflected, other = transmitted;
    if (transmits) {
        followed = transmitted;
        other = reflected;
    }
    if (depth == 0u) offer(branches.first, path, surface, bsdf, other, depth, rng);
    else offer(branches.rest, path, surface, bsdf, other, depth, rng);
    if (bsdf.probability.x > 0.0)
        offer(branches.rest, path, surface, bsdf, clearGlassRest(bsdf, random2(rng)), depth, rng);
    return followed;
}

/// Goes on with a further path, whose light is specular. Its first ray is always traced, because it may find a lamp;
/// from there on, its weight decides.
void takeBranch(inout Path path, inout Branch branch, inout uint depth) {
    path.ray = branch.ray;
    path.throughput = branch.throughput * branch.weight;
    path.diffuseShare = vec3(0.0);
    path.bsdfPdf = branch.bsdfPdf;
    path.delta = branch.delta;
    path.shares = branch.shares;
    path.further = true;
    path.channel = branch.channel;
    path.coneWidth = branch.coneWidth;
    path.medium = branch.medium;
    path.passages = branch.passages;
    path.panes = 0u;
    path.straight = 0.0;
    path.primary = 0u;
    depth = branch.depth;
    branch.weight = 0.0;
}

/// Returns the weight of the path that is taken, and 0 if none is left.
float takeBranches(inout Path path, inout Branches branches, inout uint depth) {
    float weight = branches.first.weight;
    path.reflected = 0u;
    if (weight > 0.0) {
        takeBranch(path, branches.first, depth);
        // A single colour, chosen at random, would be noise that no filter removes.
        if (path.channel == ALL_CHANNELS) path.reflected = depth;
    } else {
        weight = branches.rest.weight;
        if (weight > 0.0) takeBranch(path, branches.rest, depth);
    }
    return weight;
}

#endif
