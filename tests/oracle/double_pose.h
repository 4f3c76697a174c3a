// Poses in double precision, written only from the formulas of glTF 2.0 (sections 3.7.2.2, 3.7.3, 3.11,
// appendix C): the oracle of motion tests.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/model/scene.h"

namespace limpid::test {

using glm::dmat3;
using glm::dmat4;
using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

class DoublePose {
  public:
    DoublePose(const scene::Scene& scene, double time);

    /// Returns a corner of a triangle in world space.
    dvec3 corner(uint32_t instance, uint32_t primitive, int corner) const;
    dvec3 point(uint32_t instance, uint32_t primitive, const dvec2& barycentrics) const;
    /// Returns the interpolated vertex normal, or the triangle's if there are none; unit, in world space.
    dvec3 normal(uint32_t instance, uint32_t primitive, const dvec2& barycentrics) const;

  private:
    struct Vertex {
        dvec3 position, normal;
    };
    Vertex vertex(uint32_t instance, uint32_t index) const;
    dmat4 nodeToWorld(int node) const;

    const scene::Scene& scene_;
    std::vector<dmat4> locals_;
    std::vector<std::vector<double>> weights_;
};

}  // namespace limpid::test
