// Builds triangle meshes for the built-in scenes and for tests.
#pragma once

#include <array>
#include <cstdint>

#include "scene/model/scene.h"

namespace limpid::scene {

/// Collects faces into one mesh; front faces are counter-clockwise. Faces are flat unless a function says
/// that it adds normals: a mesh must have normals everywhere or nowhere.
class MeshBuilder {
  public:
    explicit MeshBuilder(std::string name, bool withNormals = false) : withNormals_(withNormals) {
        mesh_.name = std::move(name);
    }

    MeshBuilder& triangle(const vec3& a, const vec3& b, const vec3& c, uint16_t slot = 0);
    MeshBuilder& quad(const vec3& a, const vec3& b, const vec3& c, const vec3& d, uint16_t slot = 0);
    /// Adds an axis-aligned box with fronts outside, or inside for a room.
    MeshBuilder& box(const vec3& lower, const vec3& upper, uint16_t slot = 0, bool inside = false);
    /// Like above, but with a slot for each side: -X, +X, -Y, +Y, -Z, +Z.
    MeshBuilder& box(const vec3& lower, const vec3& upper, const std::array<uint16_t, 6>& slots, bool inside);
    /// Adds a closed prism over a convex quad (counter-clockwise from above) from y = 0 to `height`.
    MeshBuilder& prism(const vec3& a, const vec3& b, const vec3& c, const vec3& d, float height,
                       uint16_t slot = 0);
    /// Adds a latitude-longitude sphere of 2 * segments * (rings - 1) triangles.
    MeshBuilder& sphere(const vec3& center, float radius, uint32_t segments, uint32_t rings,
                        uint16_t slot = 0);
    /// Adds a ring around +Y of 2 * segments * sides triangles.
    MeshBuilder& torus(const vec3& center, float radius, float tubeRadius, uint32_t segments, uint32_t sides,
                       uint16_t slot = 0);

    Mesh take() { return std::move(mesh_); }

  private:
    uint32_t vertex(const vec3& position, const vec3& normal);
    void face(uint32_t a, uint32_t b, uint32_t c, uint16_t slot);

    Mesh mesh_;
    bool withNormals_;
};

/// Sets uv0 by projecting every face along its nearest axis, in metres: upright on walls; on floors the
/// picture's up direction is -Z. For flat meshes whose faces share no vertices.
void addWallpaperCoordinates(Mesh& mesh);

}  // namespace limpid::scene
