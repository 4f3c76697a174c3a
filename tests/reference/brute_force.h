// A ray tracer without a tree, in double precision: the reference for the shaders' traversal.
#pragma once

#include <vector>

#include "scene/model/scene.h"

namespace limpid::test {

struct TestRay {
    vec3 origin;
    vec3 direction;  ///< unit
    float tMax = 1e30f;
};

struct BruteHit {
    double t = -1.0;  ///< negative: no hit
    uint32_t instance = UINT32_MAX, primitive = UINT32_MAX;
    /// Float32 may give another result: another triangle at nearly the same distance, or a ray close to an
    /// edge.
    bool doubtful = false;
};

class BruteForce {
  public:
    explicit BruteForce(const scene::Scene& scene);

    BruteHit closest(const TestRay& ray) const;
    size_t triangleCount() const { return triangles_.size(); }
    const vec3& lower() const { return lower_; }
    const vec3& upper() const { return upper_; }

  private:
    struct Triangle {
        glm::dvec3 v0, e1, e2;
        uint32_t instance, primitive;
    };
    std::vector<Triangle> triangles_;
    vec3 lower_, upper_;
};

}  // namespace limpid::test
