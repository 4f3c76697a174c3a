#version 460
#extension GL_EXT_scalar_block_layout : require
// Scattered radiance from the two filtered sides. Where a filtered luminance is further from the noisy one than its
// standard error explains, it is moved towards the noisy one: docs/kpcn.md.
#include "denoise/stages/guides.glsl"
#include "denoise/kpcn/kpcn_params.h"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    KpcnLimitParams params;
};
#ifdef KPCN_BUFFERS
layout(set = 0, binding = 1, scalar) readonly buffer diffuseTexels { vec4 texels[]; } diffuse;
layout(set = 0, binding = 2, scalar) readonly buffer specularTexels { vec4 texels[]; } specular;
#define LOAD(clean, at) clean.texels[(at).y * params.width + (at).x]
#else
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D diffuse;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D specular;
#define LOAD(clean, at) imageLoad(clean, at)
#endif
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D albedo;
layout(set = 0, binding = 4, rgba32f) uniform readonly image2D noisyDiffuse;
layout(set = 0, binding = 5, rgba32f) uniform readonly image2D noisySpecular;
layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D scattered;

struct Side {
    vec3 clean, noisy;
    float moved;  // share of the way from clean to noisy that it is moved; negative: clean is darker than noisy
};

/// Moves it until the luminances differ by at most `standardErrors` of the noisy one's standard error.
Side sideOf(vec3 clean, vec4 texel) {
    const vec3 noisy = clamp(finiteOr(texel.rgb, vec3(0.0)), 0.0, MAX_HALF);
    if (params.standardErrors == 0.0 || !isFinite(vec3(texel.a))) return Side(clean, noisy, 0.0);
    const float reach = params.standardErrors * sqrt(max(texel.a, 0.0) * params.ofMean);
    const float apart = luminance(clean) - luminance(noisy);
    return Side(clean, noisy, abs(apart) > reach ? sign(apart) - reach / apart : 0.0);
}

struct Sides {
    Side diffuse, specular;
};

Sides sidesOf(ivec2 at) {
    const vec3 surface = clamp(finiteOr(imageLoad(albedo, at).rgb, vec3(0.0)), 0.0, MAX_ALBEDO) + KPCN_EPSILON;
    return Sides(sideOf(LOAD(diffuse, at).rgb * surface, imageLoad(noisyDiffuse, at)),
                 sideOf(exp(LOAD(specular, at).rgb) - 1.0, imageLoad(noisySpecular, at)));
}

/// Moves a pixel no further than some neighbour: `low` and `high` are the extremes of their moves. A firefly is alone.
vec3 within(Side own, float low, float high) {
    return mix(own.clean, own.noisy, abs(clamp(own.moved, min(low, 0.0), max(high, 0.0))));
}

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = ivec2(params.width, params.height);
    if (any(greaterThanEqual(at, size))) return;
    const Sides own = sidesOf(at);
    vec2 low = vec2(0.0), high = vec2(0.0);
    if (own.diffuse.moved != 0.0 || own.specular.moved != 0.0) {
        for (int k = 0; k < 9; ++k) {
            const ivec2 there = at + ivec2(k % 3, k / 3) - 1;
            if (k == 4 || any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, size))) continue;
            const Sides other = sidesOf(there);
            const vec2 moved = vec2(other.diffuse.moved, other.specular.moved);
            low = min(low, moved);
            high = max(high, moved);
        }
    }
    imageStore(scattered, at, vec4(within(own.diffuse, low.x, high.x) + within(own.specular, low.y, high.y), 1.0));
}
