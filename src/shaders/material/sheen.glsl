// KHR_materials_sheen: light that upright fibres scatter, over the rest of the material and below its clear coat. The
// distribution of A. Conty Estevez, C. Kulla, "Production friendly microfacet sheen BRDF", SIGGRAPH 2017, with their
// masking:
//
//     sheen = color * D / (4 cos(wo) cos(wi) (1 + L(wo) + L(wi))) / max(1, E(wo), E(wi))
//     f = sheen + material * (1 - max(color) * min(1, max(E(wo), E(wi))))
//
// E: the albedo of the first formula without color and the last divisor. At low roughness and grazing angles it is
// above 1, up to 3; the divisor keeps the sheen at 1, and reciprocal. The second formula is the extension's.
#ifndef LIMPID_SHEEN_GLSL
#define LIMPID_SHEEN_GLSL

#include "shaders/material/material.glsl"

struct Sheen {
    vec3 color;  // 0: none
    float roughness;
    float outside;      // E(wo)
    float albedo;       // of the strongest channel, at most 1
    float probability;  // of sampling the sheen
};

/// Returns E (scene/device/tables/sheen_table.cpp).
float sheenAlbedo(float cosine, float roughness) {
    const int size = int(SHEEN_TABLE_SIZE);
    const vec2 p = clamp(vec2(sqrt(max(cosine, 0.0)), roughness), 0.0, 1.0) * float(size - 1);
    const ivec2 base = min(ivec2(p), ivec2(size - 2));
    const vec2 f = p - vec2(base);
    const int at = int(GGX_TABLE_SIZE * (GGX_TABLE_SIZE + 1u)) + base.y * size + base.x;
    return mix(mix(imageLoad(ggxTable, at).x, imageLoad(ggxTable, at + 1).x, f.x),
               mix(imageLoad(ggxTable, at + size).x, imageLoad(ggxTable, at + size + 1).x, f.x), f.y);
}

/// Lambda of the fibres: the fit of Conty Estevez and Kulla, section 3.
float sheenLambda(float cosine, float alpha) {
    const float t = (1.0 - alpha) * (1.0 - alpha);
    const float a = mix(21.5473, 25.3245, t), b = mix(3.82987, 3.32435, t), c = mix(0.19823, 0.16801, t);
    const float d = mix(-1.97760, -1.27393, t), e = mix(-4.32054, -4.85967, t);
    const vec2 x = vec2(min(cosine, 1.0 - cosine), 0.5);
    const vec2 l = a / (1.0 + b * pow(max(x, vec2(1e-6)), vec2(c))) + d * x + e;
    return exp(cosine < 0.5 ? l.x : 2.0 * l.y - l.x);
}

/// `baseAlbedo`: roughly the reflection of the material below.
Sheen makeSheen(Surface s, float cosine, float baseAlbedo) {
    Sheen sheen;
    // Seen from inside a body, the fibres are on the other side.
    sheen.color = !s.unlit && (s.front || s.thin || !transmitsLight(s)) ? s.sheenColor : vec3(0.0);
    sheen.roughness = clamp(s.sheenRoughness, MIN_SHEEN_ROUGHNESS, 1.0);
    sheen.outside = sheenAlbedo(cosine, sheen.roughness);
    const float reflected = min(sheen.outside, 1.0);
    sheen.albedo = max(sheen.color.r, max(sheen.color.g, sheen.color.b)) * reflected;
    const float weight = luminance(sheen.color) * reflected;
    sheen.probability = weight / max(weight + (1.0 - sheen.albedo) * baseAlbedo, 1e-20);
    return sheen;
}

/// Returns f cos of a white sheen, the share of light that is left for the material below, and the density of
/// sampleSheen(). Directions are local.
vec3 evaluateSheen(Sheen sheen, vec3 wo, vec3 wi) {
    if (sheen.color == vec3(0.0)) return vec3(0.0, 1.0, 0.0);
    const float inside = sheenAlbedo(abs(wi.z), sheen.roughness);
    const float most = max(sheen.outside, inside);
    const float left = 1.0 - max(sheen.color.r, max(sheen.color.g, sheen.color.b)) * min(most, 1.0);
    if (wi.z <= 0.0) return vec3(0.0, left, 0.0);
    const float alpha = sheen.roughness * sheen.roughness;
    const vec3 m = normalize(wo + wi);
    const float distribution = (2.0 + 1.0 / alpha) * pow(dot(m.xy, m.xy), 0.5 / alpha) / (2.0 * PI);
    const float masking = 1.0 + sheenLambda(wo.z, alpha) + sheenLambda(wi.z, alpha);
    return vec3(distribution / (4.0 * wo.z * masking * max(most, 1.0)), left, 1.0 / (2.0 * PI));
}

/// Samples the hemisphere uniformly.
vec3 sampleSheen(vec2 u) {
    const float r = sqrt(u.x * (2.0 - u.x)), phi = 2.0 * PI * u.y;
    return vec3(r * cos(phi), r * sin(phi), 1.0 - u.x);
}

#endif
