#include "tests/reference/brute_force.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limpid::test {

using glm::dvec3;

BruteForce::BruteForce(const scene::Scene& scene)
    : lower_(std::numeric_limits<float>::max()), upper_(std::numeric_limits<float>::lowest()) {
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const scene::Instance& instance = scene.instances[i];
        const scene::Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        const glm::dmat4 transform(instance.transform);
        for (uint32_t t = 0; t < mesh.triangleCount(); ++t) {
            dvec3 v[3];
            for (size_t k = 0; k < 3; ++k) {
                v[k] = dvec3(transform * glm::dvec4(dvec3(mesh.positions[mesh.indices[3 * t + k]]), 1.0));
                lower_ = glm::min(lower_, vec3(v[k]));
                upper_ = glm::max(upper_, vec3(v[k]));
            }
            triangles_.push_back({v[0], v[1] - v[0], v[2] - v[0], i, t});
        }
    }
}

BruteHit BruteForce::closest(const TestRay& ray) const {
    // Within these margins of barycentrics and distances, float32 cannot decide.
    constexpr double edge = 1e-4, same = 1e-5;
    BruteHit best;
    double nearest = ray.tMax, second = std::numeric_limits<double>::max();
    std::vector<double> grazed;
    const dvec3 o(ray.origin), d(ray.direction);
    for (const Triangle& triangle : triangles_) {
        const dvec3 p = glm::cross(d, triangle.e2);
        const double determinant = glm::dot(triangle.e1, p);
        if (determinant == 0.0) continue;
        const dvec3 s = o - triangle.v0;
        const double u = glm::dot(s, p) / determinant;
        if (u < -edge || u > 1.0 + edge) continue;
        const dvec3 q = glm::cross(s, triangle.e1);
        const double v = glm::dot(d, q) / determinant, t = glm::dot(triangle.e2, q) / determinant;
        if (v < -edge || u + v > 1.0 + edge || !(t > 0.0) || t > ray.tMax) continue;
        const bool inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
        const bool atEdge = std::min({std::abs(u), std::abs(v), std::abs(1.0 - u - v)}) < edge;
        const double flat = std::abs(determinant) / (glm::length(triangle.e1) * glm::length(triangle.e2));
        if (atEdge || flat < 1e-4) grazed.push_back(t);
        if (!inside) continue;
        if (t < nearest) {
            second = nearest;
            nearest = t;
            best = {t, triangle.instance, triangle.primitive, false};
        } else {
            second = std::min(second, t);
        }
    }
    best.doubtful = second - nearest < same * nearest;
    for (const double t : grazed) best.doubtful |= best.t < 0.0 || t <= nearest * (1.0 + same);
    return best;
}

}  // namespace limpid::test
