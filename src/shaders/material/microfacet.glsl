// GGX microfacets in the local frame (normal = +Z): B. Walter et al., "Microfacet models for refraction through rough
// surfaces", EGSR 2007; masking and visible normals: E. Heitz, JCGT 2014 and 2018.
#ifndef LIMPID_MICROFACET_GLSL
#define LIMPID_MICROFACET_GLSL

#include "shaders/common/sampling.glsl"
#include "shaders/common/scene_data.glsl"

float ggxDistribution(vec3 m, float alpha) {
    const float a2 = alpha * alpha;
    // 1 - z^2 as x^2 + y^2, since the difference would cancel near the pole.
    const float d = m.x * m.x + m.y * m.y + a2 * m.z * m.z;
    return a2 / (PI * d * d);
}

float ggxLambda(float cosine, float alpha) {
    const float c2 = max(cosine * cosine, 1e-12);
    return 0.5 * (sqrt(1.0 + alpha * alpha * (1.0 - min(c2, 1.0)) / c2) - 1.0);
}

// The same with a roughness for each axis: E. Heitz, "Understanding the masking-shadowing function in microfacet-based
// BRDFs", JCGT 2014, section 5.3.

float ggxDistribution(vec3 m, vec2 alpha) {
    const vec3 v = vec3(alpha.y * m.x, alpha.x * m.y, alpha.x * alpha.y * m.z);
    const float a2 = alpha.x * alpha.y, d = dot(v, v) / a2;
    return a2 / (PI * d * d);
}

float ggxLambda(vec3 w, vec2 alpha) {
    const vec2 stretched = alpha * w.xy;
    return 0.5 * (sqrt(1.0 + dot(stretched, stretched) / max(w.z * w.z, 1e-12)) - 1.0);
}

/// Stirling's series for log Gamma(x), x >= 2, without its constant and linear terms.
float stirling(float x) {
    return (x - 0.5) * log(x) + (1.0 / 12.0 - 1.0 / (360.0 * x * x)) / x;
}

/// G2 / G1 for transmission: G2 is the Beta function of 1 + Lambda at both sides (E. Heitz et al., SIGGRAPH
/// 2016).
float transmittedMasking(float lambdaOut, float lambdaIn) {
    return exp(stirling(2.0 + lambdaOut) + stirling(2.0 + lambdaIn) - stirling(2.0 + lambdaOut + lambdaIn) - 1.0810615) /
           (1.0 + lambdaIn);
}

/// alpha: of both axes.
vec3 sampleVisibleNormal(vec3 wo, vec2 alpha, vec2 u) {
    const vec3 v = normalize(vec3(alpha * wo.xy, wo.z));
    const float length2 = dot(v.xy, v.xy);
    const vec3 t1 = length2 > 0.0 ? vec3(-v.y, v.x, 0.0) * inversesqrt(length2) : vec3(1.0, 0.0, 0.0);
    const vec3 t2 = cross(v, t1);
    const float r = sqrt(u.x), phi = 2.0 * PI * u.y, s = 0.5 * (1.0 + v.z);
    const float p1 = r * cos(phi);
    const float p2 = mix(sqrt(max(0.0, 1.0 - p1 * p1)), r * sin(phi), s);
    const vec3 n = p1 * t1 + p2 * t2 + sqrt(max(0.0, 1.0 - p1 * p1 - p2 * p2)) * v;
    return normalize(vec3(alpha * n.xy, max(0.0, n.z)));
}

vec3 sampleVisibleNormal(vec3 wo, float alpha, vec2 u) {
    return sampleVisibleNormal(wo, vec2(alpha), u);
}

float schlickWeight(float cosine) {
    const float c = clamp(1.0 - cosine, 0.0, 1.0);
    const float c2 = c * c;
    return c2 * c2 * c;
}

/// Returns the unpolarised reflectance; eta = index behind the surface over the index in front of it.
float fresnelDielectric(float cosine, float eta) {
    // Not 1 - sin^2 / eta^2, which cancels for eta near 1 at grazing angles.
    const float transmitted2 = (cosine * cosine + (eta - 1.0) * (eta + 1.0)) / (eta * eta);
    const float transmitted = sqrt(max(0.0, transmitted2));
    const float s = (cosine - eta * transmitted) / (cosine + eta * transmitted);
    const float p = (eta * cosine - transmitted) / (eta * cosine + transmitted);
    return transmitted2 <= 0.0 ? 1.0 : 0.5 * (s * s + p * p);
}

/// Returns the single-scattering albedo as F0 * x + F90 * y; z and w describe metals' multiple scattering
/// (scene/device/tables/ggx_table.cpp).
vec4 ggxAlbedo(float cosine, float roughness) {
    const float last = float(GGX_TABLE_SIZE - 1u);
    const vec2 p = clamp(vec2(cosine, roughness), 0.0, 1.0) * last;
    const vec2 base = min(floor(p), last - 1.0);
    const vec2 f = p - base;
    const int at = int(base.y) * int(GGX_TABLE_SIZE) + int(base.x);
    const int below = at + int(GGX_TABLE_SIZE);
    return mix(mix(imageLoad(ggxTable, at), imageLoad(ggxTable, at + 1), f.x),
               mix(imageLoad(ggxTable, below), imageLoad(ggxTable, below + 1), f.x), f.y);
}

/// Returns cosine-weighted averages of ggxAlbedo's x and y, and the diffuse-like share of multiple
/// scattering.
vec3 ggxAverage(float roughness) {
    const int size = int(GGX_TABLE_SIZE);
    const float p = clamp(roughness, 0.0, 1.0) * float(size - 1);
    const int row = min(int(p), size - 2);
    const int at = size * size + row;
    return mix(imageLoad(ggxTable, at).xyz, imageLoad(ggxTable, at + 1).xyz, p - float(row));
}

/// Returns one of the two texels of a table entry (scene/device/tables/dielectric_table.cpp, scene_layout.h).
vec4 dielectricEntry(float cosine, float roughness, float eta, int texel) {
    const int size = int(DIELECTRIC_TABLE_SIZE);
    const vec3 last = vec3(vec2(size - 1), float(DIELECTRIC_ETA_NODES - 1u));
    const float first = log(1.0 + SMOOTH_IOR_DIFFERENCE);
    const float etaCoordinate = log(1.0 + max(abs(log(eta)) - first, 0.0) / DIELECTRIC_ETA_SCALE) /
                                log(1.0 + (log(DIELECTRIC_ETA_MAX) - first) / DIELECTRIC_ETA_SCALE);
    const float below = min(eta, 1.0 / eta);
    const float critical = sqrt((1.0 - below) * (1.0 + below));
    const float column = cosine * (1.0 + critical) / (cosine + critical);
    const vec3 p = clamp(vec3(column, roughness, etaCoordinate), 0.0, 1.0) * last;
    const vec3 base = min(floor(p), last - 1.0);
    const vec3 f = p - base;
    const int half_ = eta < 1.0 ? 0 : int(DIELECTRIC_ETA_NODES);
    vec4 sum = vec4(0.0);
    for (int corner = 0; corner < 8; ++corner) {
        const ivec3 offset = ivec3(corner & 1, (corner >> 1) & 1, corner >> 2);
        const vec3 w = mix(1.0 - f, f, vec3(offset));
        const ivec3 i = ivec3(base) + offset;
        sum += w.x * w.y * w.z * imageLoad(dielectricTable, (((half_ + i.z) * size + i.y) * size + i.x) * 2 + texel);
    }
    return sum;
}

#endif
