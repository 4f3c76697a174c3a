#version 460
#extension GL_EXT_scalar_block_layout : require
// One level of an edge-avoiding a-trous filter over what a kernel of 21x21 pixels left of the noise: docs/kpcn.md, "Beyond the kernel".
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

const float B3[3] = float[3](6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0);
const float FARTHEST = 1e30;  // so that differences of distances are numbers

struct Surface {
    vec3 normal, albedo;  // normal: 0 if there is none; albedo: and KPCN_EPSILON
    float distance;       // 0: nothing is seen
};

bool inPicture(ivec2 at) {
    return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(params.width, params.height)));
}

float distanceAt(ivec2 at) {
    return min(hitDistance(imageLoad(depth, at)), FARTHEST);
}

Surface surfaceAt(ivec2 at) {
    const vec3 reflected = clamp(finiteOr(imageLoad(albedo, at).rgb, vec3(0.0)), 0.0, MAX_ALBEDO) + KPCN_EPSILON;
    return Surface(unitNormal(imageLoad(normal, at)), reflected, distanceAt(at));
}

/// How much the distance grows by a pixel along `axis`: the smaller one of the differences to both sides, for the other may be
/// to another surface.
float slopeAlong(ivec2 at, ivec2 axis, float here) {
    const bool hasAfter = inPicture(at + axis), hasBefore = inPicture(at - axis);
    const float after = hasAfter ? distanceAt(at + axis) - here : 0.0, before = hasBefore ? here - distanceAt(at - axis) : 0.0;
    if (hasAfter != hasBefore) return hasAfter ? after : before;
    return abs(after) < abs(before) ? after : before;
}

/// The exponent of a weight, for a surface `from` pixels away.
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

/// What of light x makes its luminance, in units of its deviation. Diffuse light has a color that the surface may not reflect:
/// its deviation is that of the reflected luminance.
vec3 luminanceWeights(Surface own) {
    const vec3 weights = vec3(0.2126, 0.7152, 0.0722);
    return params.specular != 0u ? weights : weights * own.albedo / luminance(own.albedo);
}

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (!inPicture(at)) return;
    const vec4 own = LOAD(at);
    const Surface surface = surfaceAt(at);
    const vec2 slope = vec2(slopeAlong(at, ivec2(1, 0), surface.distance), slopeAlong(at, ivec2(0, 1), surface.distance));
    const vec3 weights = luminanceWeights(surface) / (params.phiColor * own.a + 1e-6);
    vec4 sum = vec4(0.0);
    float squares = 0.0;
    for (int j = -2; j <= 2; ++j) {
        for (int i = -2; i <= 2; ++i) {
            const ivec2 from = params.step * ivec2(i, j), there = at + from;
            if (!inPicture(there)) continue;
            const vec4 other = LOAD(there);
            const float apart = dot(other.rgb - own.rgb, weights);
            const float weight = B3[abs(i)] * B3[abs(j)] * exp(surfaceExponent(surface, slope, surfaceAt(there), from) - apart * apart);
            sum += weight * vec4(other.rgb, 1.0);
            squares += weight * weight * other.a * other.a;
        }
    }
    STORE(at, vec4(sum.rgb, sqrt(squares)) / sum.a);
}
