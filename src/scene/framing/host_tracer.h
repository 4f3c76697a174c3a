// Traces rays on the CPU, for the few thousand that analysing a scene needs before it is on a device.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene/device/trees/bvh.h"
#include "scene/model/scene.h"

namespace limpid::scene {

/// A ray's hit on a triangle.
struct HostHit {
    float t = 0.0f;
    float u = 0.0f, v = 0.0f;  ///< barycentrics of vertices 1 and 2
    uint32_t triangle = 0;
};

struct HostTriangle {
    vec3 v0{0.0f}, edge1{0.0f}, edge2{0.0f};  ///< world space, at rest
    uint32_t instance = 0, primitive = 0;     ///< of the instance's mesh

    vec3 areaNormal() const { return glm::cross(edge1, edge2); }
};

class HostTracer {
  public:
    /// Keeps a reference to the scene, which must outlive it.
    explicit HostTracer(const Scene& scene);

    /// Returns the nearest hit between `nearest` and `farthest` along the direction, which need not be a unit
    /// vector. At masked or blended materials, `random` (0 to 1) decides whether the ray passes through.
    std::optional<HostHit> closest(const vec3& origin, const vec3& direction, float nearest, float farthest,
                                   float random) const;

    const std::vector<HostTriangle>& triangles() const { return triangles_; }
    const Material& materialOf(const HostTriangle& triangle) const;
    /// Returns the linear texel; white if there is no texture.
    vec4 textureAt(const TextureRef& ref, const HostTriangle& triangle, float u, float v) const;

  private:
    void testLeaf(uint32_t leaf, const vec3& origin, const vec3& direction, float nearest, float random,
                  HostHit& best, bool& found) const;
    bool passes(const HostTriangle& triangle, const HostHit& hit, float random) const;

    const Scene& scene_;
    std::vector<HostTriangle> triangles_;
    Bvh bvh_;
};

}  // namespace limpid::scene
