// Quadrature for the tables of microfacet albedos: quasi-random visible normals (E. Heitz, "Sampling the GGX
// distribution of visible normals", JCGT 2018). The formulas are those of shaders/microfacet.glsl.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/math.h"

namespace limpid::scene {

/// Returns point i of the Hammersley set.
inline vec2 hammersley(uint32_t i, uint32_t count) {
    uint32_t reversed = 0;
    for (uint32_t bit = 0; bit < 32; ++bit) reversed |= (i >> bit & 1u) << (31 - bit);
    return {(static_cast<float>(i) + 0.5f) / static_cast<float>(count),
            static_cast<float>(reversed) * 0x1p-32f};
}

inline vec3 directionAt(float cosine) {
    return {std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)), 0.0f, cosine};
}

/// Returns `count` points of the unit disk, evenly distributed over the angles from `firstTurn` to `lastTurn`
/// (1: a full turn).
inline std::vector<vec2> diskPoints(uint32_t count, float firstTurn = 0.0f, float lastTurn = 1.0f) {
    std::vector<vec2> points(count);
    for (uint32_t i = 0; i < count; ++i) {
        const vec2 u = hammersley(i, count);
        const float r = std::sqrt(u.x), phi = 2.0f * pi * glm::mix(firstTurn, lastTurn, u.y);
        points[i] = {r * std::cos(phi), r * std::sin(phi)};
    }
    return points;
}

/// The normals of the facets visible from wo, mapped from evenly distributed points of the disk.
class VisibleNormals {
  public:
    VisibleNormals(const vec3& wo, float alpha)
        : alpha_(alpha), v_(glm::normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z))) {
        const float length2 = v_.x * v_.x + v_.y * v_.y;
        t1_ = length2 > 0.0f ? vec3(-v_.y, v_.x, 0.0f) / std::sqrt(length2) : vec3(1, 0, 0);
        t2_ = glm::cross(v_, t1_);
    }

    vec3 operator()(const vec2& disk) const {
        const float s = 0.5f * (1.0f + v_.z), p1 = disk.x;
        const float p2 = (1.0f - s) * std::sqrt(std::max(0.0f, 1.0f - p1 * p1)) + s * disk.y;
        const vec3 n = p1 * t1_ + p2 * t2_ + std::sqrt(std::max(0.0f, 1.0f - p1 * p1 - p2 * p2)) * v_;
        return glm::normalize(vec3(alpha_ * n.x, alpha_ * n.y, std::max(0.0f, n.z)));
    }

  private:
    float alpha_;
    vec3 v_, t1_, t2_;
};

/// Smith's Lambda for GGX.
inline float smithLambda(float cosine, float alpha) {
    const float c2 = cosine * cosine;
    return 0.5f * (std::sqrt(1.0f + alpha * alpha * (1.0f - c2) / std::max(c2, 1e-12f)) - 1.0f);
}

/// Stirling's series for log Gamma(x), x >= 2, without its constant and linear terms.
inline float stirling(float x) {
    return (x - 0.5f) * std::log(x) + (1.0f / 12.0f - 1.0f / (360.0f * x * x)) / x;
}

/// The fraction of light transmitted by visible facets that escapes on the other side: G2 / G1, where G2 is
/// the Beta function of 1 + Lambda at both directions (Heitz et al. 2016, "Multiple-scattering microfacet
/// BSDFs with the Smith model").
inline float transmittedMasking(float lambdaOut, float lambdaIn) {
    return std::exp(stirling(2.0f + lambdaOut) + stirling(2.0f + lambdaIn) -
                    stirling(2.0f + lambdaOut + lambdaIn) - 1.0810615f) /
           (1.0f + lambdaIn);
}

/// The share of multiple scattering that follows the single-facet lobe; the rest is diffuse. Nearly all on
/// smooth surfaces, nearly none at roughness 1. Fitted to random walks (tests/reference/microfacet_walk.h).
inline float followingShare(float roughness) {
    return 1.0f / (1.0f + std::pow(2.0f * roughness, 5.0f));
}

}  // namespace limpid::scene
