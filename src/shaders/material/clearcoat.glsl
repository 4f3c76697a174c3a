// KHR_materials_clearcoat: a layer of GGX facets of a dielectric of index 1.5, with a normal of its own, over
// the rest of the material.
//
//     f = weight * coat + (1 - weight * E(wo)) * material,   E: the coat's reflection of uniform light
//
// The extension leaves the layering operator open and suggests the Fresnel term at the viewer's cosine for E.
// That is E for a smooth coat; for a rough one, E also includes the facets' angles and masking, so that a
// coat over a white material is white. Emission is below the coat too.
#ifndef LIMPID_CLEARCOAT_GLSL
#define LIMPID_CLEARCOAT_GLSL

#include "shaders/material/material.glsl"

struct Clearcoat {
    mat3 frame;
    vec3 wo;
    float weight, alpha;
    float albedo;       // weight * E(wo)
    float probability;  // of sampling the coat
    bool smoothSurface;
};

float clearcoatFresnel(float cosine) {
    return mix(CLEARCOAT_F0, 1.0, schlickWeight(cosine));
}

/// `baseAlbedo`: roughly the reflection of the material below.
Clearcoat makeClearcoat(Surface s, vec3 toViewer, float baseAlbedo) {
    Clearcoat c;
    c.frame = frameAround(s.clearcoatNormal);
    c.wo = toViewer * c.frame;
    // Seen from inside a body, the coat is on the other side, where light leaves the body.
    c.weight = s.front || s.thin || s.transmission == 0.0 ? s.clearcoat : 0.0;
    c.alpha = max(s.clearcoatRoughness * s.clearcoatRoughness, 1e-4);
    c.smoothSurface = s.clearcoatRoughness < SMOOTH_ROUGHNESS;
    const vec4 albedo = ggxAlbedo(c.wo.z, s.clearcoatRoughness);
    c.albedo = c.weight * (c.smoothSurface ? clearcoatFresnel(c.wo.z) : CLEARCOAT_F0 * albedo.x + albedo.y);
    c.probability = c.albedo / max(c.albedo + (1.0 - c.albedo) * baseAlbedo, 1e-20);
    return c;
}

/// Returns f cos and the density of sampleClearcoat; 0 for a smooth coat. `normal` is the geometric one, on
/// the viewer's side.
vec2 evaluateClearcoat(Clearcoat c, vec3 normal, vec3 direction) {
    const vec3 wi = direction * c.frame;
    if (c.smoothSurface || wi.z <= 0.0 || dot(direction, normal) <= 0.0) return vec2(0.0);
    const vec3 m = normalize(c.wo + wi);
    const float lambdaOut = ggxLambda(c.wo.z, c.alpha), lambdaIn = ggxLambda(wi.z, c.alpha);
    const float pdf = ggxDistribution(m, c.alpha) / (4.0 * c.wo.z * (1.0 + lambdaOut));
    return vec2(c.weight * clearcoatFresnel(dot(c.wo, m)) * (1.0 + lambdaOut) / (1.0 + lambdaOut + lambdaIn), 1.0) * pdf;
}

/// Samples a direction (world space) of the coat's reflection; it may point below the surface.
vec3 sampleClearcoat(Clearcoat c, vec2 u) {
    const vec3 m = c.smoothSurface ? vec3(0.0, 0.0, 1.0) : sampleVisibleNormal(c.wo, c.alpha, u);
    return c.frame * (2.0 * dot(c.wo, m) * m - c.wo);
}

#endif
