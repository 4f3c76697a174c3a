#include "scene/builtin/mesh_builder.h"

#include <cmath>

#include "scene/model/aabb.h"

namespace limpid::scene {

uint32_t MeshBuilder::vertex(const vec3& position, const vec3& normal) {
    mesh_.positions.push_back(position);
    if (withNormals_) mesh_.normals.push_back(normal);
    return static_cast<uint32_t>(mesh_.positions.size() - 1);
}

void MeshBuilder::face(uint32_t a, uint32_t b, uint32_t c, uint16_t slot) {
    mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
    mesh_.materialSlots.push_back(slot);
}

MeshBuilder& MeshBuilder::triangle(const vec3& a, const vec3& b, const vec3& c, uint16_t slot) {
    const vec3 n = glm::normalize(glm::cross(b - a, c - a));
    const uint32_t first = vertex(a, n);
    vertex(b, n);
    vertex(c, n);
    face(first, first + 1, first + 2, slot);
    return *this;
}

MeshBuilder& MeshBuilder::quad(const vec3& a, const vec3& b, const vec3& c, const vec3& d, uint16_t slot) {
    const vec3 n = glm::normalize(glm::cross(b - a, c - a));
    const uint32_t first = vertex(a, n);
    vertex(b, n);
    vertex(c, n);
    vertex(d, n);
    face(first, first + 1, first + 2, slot);
    face(first, first + 2, first + 3, slot);
    return *this;
}

MeshBuilder& MeshBuilder::box(const vec3& lower, const vec3& upper, uint16_t slot, bool inside) {
    return box(lower, upper, {slot, slot, slot, slot, slot, slot}, inside);
}

MeshBuilder& MeshBuilder::box(const vec3& lower, const vec3& upper, const std::array<uint16_t, 6>& slots,
                              bool inside) {
    const Aabb bounds{lower, upper};
    constexpr int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                 {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (size_t side = 0; side < slots.size(); ++side) {
        const auto& f = faces[side];
        if (inside) {
            quad(bounds.corner(f[3]), bounds.corner(f[2]), bounds.corner(f[1]), bounds.corner(f[0]),
                 slots[side]);
        } else {
            quad(bounds.corner(f[0]), bounds.corner(f[1]), bounds.corner(f[2]), bounds.corner(f[3]),
                 slots[side]);
        }
    }
    return *this;
}

MeshBuilder& MeshBuilder::prism(const vec3& a, const vec3& b, const vec3& c, const vec3& d, float height,
                                uint16_t slot) {
    const vec3 up(0.0f, height, 0.0f);
    quad(a + up, b + up, c + up, d + up, slot);
    quad(d, c, b, a, slot);
    quad(a, b, b + up, a + up, slot);
    quad(b, c, c + up, b + up, slot);
    quad(c, d, d + up, c + up, slot);
    return quad(d, a, a + up, d + up, slot);
}

MeshBuilder& MeshBuilder::sphere(const vec3& center, float radius, uint32_t segments, uint32_t rings,
                                 uint16_t slot) {
    const auto first = static_cast<uint32_t>(mesh_.positions.size());
    for (uint32_t ring = 0; ring <= rings; ++ring) {
        const float theta = pi * static_cast<float>(ring) / static_cast<float>(rings);
        // sin(pi) is not exactly 0 in float, but the poles' vertices must coincide or the sphere has cracks.
        const float sine = ring == 0 || ring == rings ? 0.0f : std::sin(theta);
        for (uint32_t segment = 0; segment <= segments; ++segment) {
            const float phi =
                2.0f * pi * static_cast<float>(segment % segments) / static_cast<float>(segments);
            const vec3 n(sine * std::cos(phi), std::cos(theta), -sine * std::sin(phi));
            vertex(center + radius * n, n);
        }
    }
    for (uint32_t ring = 0; ring < rings; ++ring) {
        for (uint32_t segment = 0; segment < segments; ++segment) {
            const uint32_t a = first + ring * (segments + 1) + segment, b = a + segments + 1;
            if (ring > 0) face(a, b, a + 1, slot);
            if (ring + 1 < rings) face(a + 1, b, b + 1, slot);
        }
    }
    return *this;
}

MeshBuilder& MeshBuilder::torus(const vec3& center, float radius, float tubeRadius, uint32_t segments,
                                uint32_t sides, uint16_t slot) {
    const auto first = static_cast<uint32_t>(mesh_.positions.size());
    for (uint32_t segment = 0; segment <= segments; ++segment) {
        const float phi = 2.0f * pi * static_cast<float>(segment % segments) / static_cast<float>(segments);
        const vec3 outward(std::cos(phi), 0.0f, -std::sin(phi));
        for (uint32_t side = 0; side <= sides; ++side) {
            const float psi = 2.0f * pi * static_cast<float>(side % sides) / static_cast<float>(sides);
            const vec3 n = std::cos(psi) * outward + vec3(0.0f, std::sin(psi), 0.0f);
            vertex(center + radius * outward + tubeRadius * n, n);
        }
    }
    for (uint32_t segment = 0; segment < segments; ++segment) {
        for (uint32_t side = 0; side < sides; ++side) {
            const uint32_t a = first + segment * (sides + 1) + side, b = a + sides + 1;
            face(a, b, b + 1, slot);
            face(a, b + 1, a + 1, slot);
        }
    }
    return *this;
}

void addWallpaperCoordinates(Mesh& mesh) {
    mesh.uv0.assign(mesh.positions.size(), vec2(0.0f));
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        const vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                   c = mesh.positions[mesh.indices[i + 2]];
        const vec3 normal = glm::cross(b - a, c - a), size = glm::abs(normal);
        for (size_t k = 0; k < 3; ++k) {
            const vec3 p = mesh.positions[mesh.indices[i + k]];
            vec2& uv = mesh.uv0[mesh.indices[i + k]];
            if (size.y >= size.x && size.y >= size.z) {
                uv = {p.x, normal.y > 0.0f ? p.z : -p.z};
            } else if (size.x >= size.z) {
                uv = {normal.x > 0.0f ? -p.z : p.z, -p.y};
            } else {
                uv = {normal.z > 0.0f ? p.x : -p.x, -p.y};
            }
        }
    }
}

}  // namespace limpid::scene
