// Reference formulas for shaders, in double precision: B. Walter et al., "Microfacet models for refraction
// through rough surfaces", EGSR 2007; E. Heitz, "Understanding the masking-shadowing function in
// microfacet-based BRDFs", JCGT 2014.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/math.h"
#include "shaders/common/scene_layout.h"

namespace limpid::test {

using dvec3 = glm::dvec3;
inline constexpr double pi64 = std::numbers::pi;

/// GGX by the slope of the half vector (Walter, equation 33).
inline double distribution(const dvec3& m, double alpha) {
    const double tan2 = (m.x * m.x + m.y * m.y) / (m.z * m.z);
    const double cos4 = m.z * m.z * m.z * m.z;
    return alpha * alpha / (pi64 * cos4 * std::pow(alpha * alpha + tan2, 2.0));
}

/// Heitz 2014, equation 72.
inline double lambda(const dvec3& v, double alpha) {
    const double tan2 = (v.x * v.x + v.y * v.y) / (v.z * v.z);
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * tan2) - 1.0);
}

inline double schlick(double f0, double f90, double cosine) {
    return f0 + (f90 - f0) * std::pow(1.0 - cosine, 5.0);
}

/// f cos of reflection with height-correlated masking.
inline double reflected(const dvec3& wo, const dvec3& wi, double alpha, double f0, double f90) {
    const dvec3 m = glm::normalize(wo + wi);
    const double g2 = 1.0 / (1.0 + lambda(wo, alpha) + lambda(wi, alpha));
    return schlick(f0, f90, glm::dot(wo, m)) * distribution(m, alpha) * g2 / (4.0 * wo.z);
}

/// Looks up the table of albedos bilinearly, as the layout header describes.
inline glm::dvec4 ggxTable(const std::vector<vec4>& table, double cosine, double roughness) {
    const int size = static_cast<int>(layout::GGX_TABLE_SIZE);
    const double x = cosine * (size - 1), y = roughness * (size - 1);
    const int i = std::min(static_cast<int>(x), size - 2), j = std::min(static_cast<int>(y), size - 2);
    const auto at = [&](int a, int b) { return glm::dvec4(table[static_cast<size_t>(b * size + a)]); };
    return glm::mix(glm::mix(at(i, j), at(i + 1, j), x - i), glm::mix(at(i, j + 1), at(i + 1, j + 1), x - i),
                    y - j);
}

/// Returns the row averages of that table.
inline glm::dvec4 ggxAverages(const std::vector<vec4>& table, double roughness) {
    const int size = static_cast<int>(layout::GGX_TABLE_SIZE);
    const double y = roughness * (size - 1);
    const int j = std::min(static_cast<int>(y), size - 2);
    const auto at = [&](int row) { return glm::dvec4(table[static_cast<size_t>(size * size + row)]); };
    return glm::mix(at(j), at(j + 1), y - j);
}

}  // namespace limpid::test
