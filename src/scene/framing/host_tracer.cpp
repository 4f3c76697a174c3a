#include "scene/framing/host_tracer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/device/mip_levels.h"
#include "scene/model/transform.h"

namespace limpid::scene {
namespace {

/// Three entries per level; buildBvh() makes no tree deeper than maxSahDepth plus the logarithm of 2^28.
constexpr size_t maxStack = size_t{3} * (maxSahDepth + 28) + 4;

/// Returns true if the ray passes through the box between the two distances. `inverse` is one over its
/// direction.
bool meets(const Aabb& box, const vec3& origin, const vec3& inverse, float nearest, float farthest) {
    const vec3 a = (box.lower - origin) * inverse, b = (box.upper - origin) * inverse;
    const vec3 low = glm::min(a, b), high = glm::max(a, b);
    const float enter = std::max({low.x, low.y, low.z, nearest});
    const float leave = std::min({high.x, high.y, high.z, farthest});
    return enter <= leave * 1.00001f;
}

std::vector<HostTriangle> worldTriangles(const Scene& scene) {
    std::vector<HostTriangle> triangles;
    triangles.reserve(scene.triangleCount());
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        const auto at = [&](size_t index) {
            return transformPoint(instance.transform, mesh.positions[mesh.indices[index]]);
        };
        for (size_t t = 0; t < mesh.triangleCount(); ++t) {
            const vec3 v0 = at(3 * t);
            triangles.push_back({v0, at(3 * t + 1) - v0, at(3 * t + 2) - v0, static_cast<uint32_t>(i),
                                 static_cast<uint32_t>(t)});
        }
    }
    return triangles;
}

Bvh treeOf(const std::vector<HostTriangle>& triangles) {
    std::vector<Aabb> boxes(triangles.size());
    for (size_t i = 0; i < triangles.size(); ++i) {
        const HostTriangle& t = triangles[i];
        for (const vec3& p : {t.v0, t.v0 + t.edge1, t.v0 + t.edge2}) boxes[i].grow(p);
    }
    return buildBvh(boxes, 4);
}

}  // namespace

HostTracer::HostTracer(const Scene& scene)
    : scene_(scene), triangles_(worldTriangles(scene)), bvh_(treeOf(triangles_)) {}

const Material& HostTracer::materialOf(const HostTriangle& triangle) const {
    const Instance& instance = scene_.instances[triangle.instance];
    const Mesh& mesh = scene_.meshes[static_cast<size_t>(instance.mesh)];
    const size_t slot = mesh.materialSlots.empty() ? 0 : mesh.materialSlots[triangle.primitive];
    return scene_.materials[static_cast<size_t>(instance.material) + slot];
}

vec4 HostTracer::textureAt(const TextureRef& ref, const HostTriangle& triangle, float u, float v) const {
    const Mesh& mesh = scene_.meshes[static_cast<size_t>(scene_.instances[triangle.instance].mesh)];
    const std::vector<vec2>& uv = ref.uvSet == 1 ? mesh.uv1 : mesh.uv0;
    if (!ref || uv.empty()) return vec4(1.0f);
    const uint32_t* index = &mesh.indices[size_t{3} * triangle.primitive];
    const vec3 p((1.0f - u - v) * uv[index[0]] + u * uv[index[1]] + v * uv[index[2]], 1.0f);
    return nearestTexel(scene_.textures[static_cast<size_t>(ref.texture)],
                        {glm::dot(ref.rowU, p), glm::dot(ref.rowV, p)});
}

bool HostTracer::passes(const HostTriangle& triangle, const HostHit& hit, float random) const {
    const Material& material = materialOf(triangle);
    if (material.alphaMode == AlphaMode::Opaque) return false;
    const float alpha = material.baseColor.a * textureAt(material.baseColorTexture, triangle, hit.u, hit.v).a;
    return alpha < (material.alphaMode == AlphaMode::Mask ? material.alphaCutoff : random);
}

/// T. Moeller, B. Trumbore, "Fast, minimum storage ray-triangle intersection", 1997.
void HostTracer::testLeaf(uint32_t leaf, const vec3& origin, const vec3& direction, float nearest,
                          float random, HostHit& best, bool& found) const {
    for (uint32_t i = 0; i < BvhRef::count(leaf); ++i) {
        const uint32_t index = bvh_.order[BvhRef::first(leaf) + i];
        const HostTriangle& t = triangles_[index];
        const vec3 p = glm::cross(direction, t.edge2);
        const float determinant = glm::dot(t.edge1, p);
        if (determinant == 0.0f) continue;
        const vec3 s = origin - t.v0, q = glm::cross(s, t.edge1);
        const HostHit hit{glm::dot(t.edge2, q) / determinant, glm::dot(s, p) / determinant,
                          glm::dot(direction, q) / determinant, index};
        const bool inside = hit.u >= 0.0f && hit.v >= 0.0f && hit.u + hit.v <= 1.0f;
        if (!inside || !(hit.t > nearest && hit.t < best.t) || passes(t, hit, random)) continue;
        best = hit;
        found = true;
    }
}

std::optional<HostHit> HostTracer::closest(const vec3& origin, const vec3& direction, float nearest,
                                           float farthest, float random) const {
    HostHit best{.t = farthest};
    bool found = false;
    const vec3 inverse = 1.0f / direction;
    std::array<uint32_t, maxStack> stack;
    size_t depth = 0;
    stack[depth++] = BvhRef::node(0);
    while (depth > 0) {
        const uint32_t ref = stack[--depth];
        if (BvhRef::isLeaf(ref)) {
            testLeaf(ref, origin, direction, nearest, random, best, found);
            continue;
        }
        const BvhNode& node = bvh_.nodes[ref];
        for (uint32_t child = 0; child < 4; ++child) {
            if (node.hasChild(child) && meets(node.childBounds(child), origin, inverse, nearest, best.t))
                stack[depth++] = node.children[child];
        }
    }
    return found ? std::optional(best) : std::nullopt;
}

}  // namespace limpid::scene
