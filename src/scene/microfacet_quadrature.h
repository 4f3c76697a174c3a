// What the tables of microfacet albedos integrate with: quasi-random visible normals (E. Heitz, "Sampling the
// GGX distribution of visible normals", JCGT 2018). The formulas are those of shaders/microfacet.glsl.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/math.h"

namespace limpid::scene {

/// Point i of the Hammersley set.
inline vec2 hammersley(uint32_t i, uint32_t count) {
    uint32_t reversed = 0;
    for (uint32_t bit = 0; bit < 32; ++bit) reversed |= (i >> bit & 1u) << (31 - bit);
    return {(static_cast<float>(i) + 0.5f) / static_cast<float>(count),
            static_cast<float>(reversed) * 0x1p-32f};
}

inline vec3 directionAt(float cosine) {
    return {std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)), 0.0f, cosine};
}

inline vec3 sampleVisibleNormal(const vec3& wo, float alpha, const vec2& u) {
    const vec3 v = glm::normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
    const float length2 = v.x * v.x + v.y * v.y;
    const vec3 t1 = length2 > 0.0f ? vec3(-v.y, v.x, 0.0f) / std::sqrt(length2) : vec3(1, 0, 0);
    const vec3 t2 = glm::cross(v, t1);
    const float r = std::sqrt(u.x), phi = 2.0f * pi * u.y, s = 0.5f * (1.0f + v.z);
    const float p1 = r * std::cos(phi);
    const float p2 = (1.0f - s) * std::sqrt(std::max(0.0f, 1.0f - p1 * p1)) + s * r * std::sin(phi);
    const vec3 n = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0f, 1.0f - p1 * p1 - p2 * p2)) * v;
    return glm::normalize(vec3(alpha * n.x, alpha * n.y, std::max(0.0f, n.z)));
}

/// Smith's Lambda for GGX.
inline float smithLambda(float cosine, float alpha) {
    const float c2 = cosine * cosine;
    return 0.5f * (std::sqrt(1.0f + alpha * alpha * (1.0f - c2) / std::max(c2, 1e-12f)) - 1.0f);
}

/// Stirling's series for log Gamma(x), x >= 2, without its constant and linear terms.
inline float stirling(float x) {
    return (x - 0.5f) * std::log(x) + (1.0f / 12.0f - 1.0f / (360.0f * x * x)) / x;
}

/// How much of what facets transmit from a direction that is seen escapes on the other side: G2 / G1 with G2
/// the Beta function of 1 + Lambda at both (Heitz et al. 2016, "Multiple-scattering microfacet BSDFs with the
/// Smith model").
inline float transmittedMasking(float lambdaOut, float lambdaIn) {
    return std::exp(stirling(2.0f + lambdaOut) + stirling(2.0f + lambdaIn) -
                    stirling(2.0f + lambdaOut + lambdaIn) - 1.0810615f) /
           (1.0f + lambdaIn);
}

/// Which share of what several facets scatter follows the lobe of one facet, rather than spreads like diffuse
/// light: nearly all on smooth surfaces, nearly none at roughness 1. Fitted to random walks
/// (tests/microfacet_walk.h).
inline float followingShare(float roughness) {
    return 1.0f / (1.0f + std::pow(2.0f * roughness, 5.0f));
}

}  // namespace limpid::scene
