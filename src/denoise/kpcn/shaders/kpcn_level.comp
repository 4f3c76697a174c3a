#version 460
#extension GL_EXT_scalar_block_layout : require
// One level of an edge-avoiding a-trous filter that removes the noise left by the network's kernels: docs/kpcn.md,
// "Beyond the kernel".
#include "denoise/stages/guides.glsl"
#include "denoise/kpcn/kpcn_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    KpcnLevelParams params;
};
#ifdef KPCN_BUFFERS
layout(set = 0, binding = 1, scalar) readonly buffer cleanTexels { vec4 texels[]; } clean;
layout(set = 0, binding = 2, scalar) writeonly buffer filteredTexels { vec4 texels[]; } filtered;
#define LOAD(at) clean.texels[(at).y * params.width + (at).x]
#define STORE(at, value) filtered.texels[(at).y * params.width + (at).x] = value
#else
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D clean;
layout(set = 0, binding = 2, rgba32f) uniform writeonly image2D filtered;
#define LOAD(at) imageLoad(clean, at)
#define STORE(at, value) imageStore(filtered, at, value)
#endif
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D normal;
layout(set = 0, binding = 4, rgba32f) uniform readonly image2D depth;
layout(set = 0, binding = 5, rgba32f) uniform readonly image2D albedo;

#include "denoise/stages/atrous/kernel.glsl"

const ivec2 BLOCK = ivec2(1);
const int REACH = 2;
const float FARTHEST = 1e30;  // so that differences of distances are finite

struct Surface {
    vec3 normal;     // 0: there is none
    vec3 albedo;     // plus KPCN_EPSILON
    float distance;  // 0: nothing is seen
};

struct Tap {
    vec4 light;  // and its deviation
    Surface surface;
    bool counts;
};

struct Centre {
    vec4 light;
    Surface surface;
    vec2 slope;  // change of the distance by a pixel to the right, and down
    vec3 luminanceWeights;
    vec4 sum;       // of weighted light, and of the weights
    float squares;  // sum of squared weighted deviations
};

float distanceAt(ivec2 at) {
    return min(hitDistance(imageLoad(depth, at)), FARTHEST);
}

Surface surfaceAt(ivec2 at) {
    const vec3 reflected = clamp(finiteOr(imageLoad(albedo, at).rgb, vec3(0.0)), 0.0, MAX_ALBEDO) + KPCN_EPSILON;
    return Surface(unitNormal(imageLoad(normal, at)), reflected, distanceAt(at));
}

/// How much the distance grows by a pixel along `axis`: the smaller of the differences to both sides, because the
/// other one may lead to another surface.
float slopeAlong(ivec2 at, ivec2 axis, float here) {
    const bool hasAfter = inPicture(at + axis), hasBefore = inPicture(at - axis);
    const float after = hasAfter ? distanceAt(at + axis) - here : 0.0, before = hasBefore ? here - distanceAt(at - axis) : 0.0;
    if (hasAfter != hasBefore) return hasAfter ? after : before;
    return abs(after) < abs(before) ? after : before;
}

/// The exponent of a weight for another surface, `from` pixels away.
float surfaceExponent(Surface own, vec2 slope, Surface other, ivec2 from) {
    if ((own.distance > 0.0) != (other.distance > 0.0)) return -1e30;
    if (own.distance <= 0.0) return 0.0;
    const bool hasNormal = own.normal != vec3(0.0);
    if (hasNormal != (other.normal != vec3(0.0))) return -1e30;
    const float bend = hasNormal ? 1.0 - dot(own.normal, other.normal) : 0.0;
    const float away = (other.distance - own.distance - dot(slope, vec2(from))) / (KPCN_LEVEL_DEPTH * own.distance);
    const vec3 colors = (other.albedo - own.albedo) / (KPCN_LEVEL_ALBEDO * own.albedo);
    return -away * away - dot(colors, colors) - KPCN_LEVEL_NORMAL * bend;
}

/// The weights of light's components in its luminance. Diffuse light is without albedo: its luminance and deviation
/// are those of the reflected light, relative to the albedo's luminance.
vec3 luminanceWeights(Surface own) {
    const vec3 weights = vec3(0.2126, 0.7152, 0.0722);
    return params.specular != 0u ? weights : weights * own.albedo / luminance(own.albedo);
}

Tap loadTap(ivec2 at) {
    const ivec2 inside = clamp(at, ivec2(0), ivec2(params.width, params.height) - 1);
    return Tap(LOAD(inside), surfaceAt(inside), at == inside);
}

Centre begin(ivec2 at, int number) {
    const Tap tap = loadTap(at);
    const Surface own = tap.surface;
    const float weight = splineWeight(ivec2(0));
    return Centre(tap.light, own,
                  vec2(slopeAlong(at, ivec2(1, 0), own.distance), slopeAlong(at, ivec2(0, 1), own.distance)),
                  luminanceWeights(own) / (params.phiColor * tap.light.a + 1e-6), weight * vec4(tap.light.rgb, 1.0),
                  weight * weight * tap.light.a * tap.light.a);
}

void addTo(inout Centre centre, Tap tap, ivec2 from) {
    if (!tap.counts) return;
    const float apart = dot(tap.light.rgb - centre.light.rgb, centre.luminanceWeights);
    const float exponent = surfaceExponent(centre.surface, centre.slope, tap.surface, params.step * from) - apart * apart;
    const float weight = splineWeight(from) * exp(exponent);
    centre.sum += weight * vec4(tap.light.rgb, 1.0);
    centre.squares += weight * weight * tap.light.a * tap.light.a;
}

void store(ivec2 at, Centre centre) {
    STORE(at, vec4(centre.sum.rgb, sqrt(centre.squares)) / centre.sum.a);
}

bool isFiltered(Centre centre) {
    return true;
}

#include "denoise/stages/atrous/level.glsl"

void main() {
    const ivec2 first = firstOfBlock(ivec2(gl_GlobalInvocationID.xy));
    if (inPicture(first)) filterBlock(first);
}
