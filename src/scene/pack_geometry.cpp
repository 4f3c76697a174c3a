#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <limits>
#include <optional>

#include "base/error.h"
#include "scene/pack.h"

namespace limpid::scene {
namespace {

/// Triangles per leaf: larger leaves cost more tests but fewer nodes (measured in docs/benchmarks.md).
constexpr uint32_t maxTrianglesPerLeaf = 4;
/// A mesh whose copies together have at most this many triangles is copied into the static tree instead of
/// instanced: one tree is walked faster than a tree over trees.
constexpr size_t mergeLimit = 4096;

vec2 octahedral(const vec3& direction) {
    const vec3 n = direction / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
    if (n.z >= 0.0f) return {n.x, n.y};
    const vec2 folded = 1.0f - glm::abs(vec2(n.y, n.x));
    return {n.x >= 0.0f ? folded.x : -folded.x, n.y >= 0.0f ? folded.y : -folded.y};
}

uint32_t packDirection(const vec3& direction) {
    return glm::packSnorm2x16(octahedral(direction));
}

/// A direction that stays usable when the transform or the input degenerates.
vec3 safeNormalize(const vec3& v, const vec3& otherwise) {
    const float length = glm::length(v);
    return length > 1e-20f && std::isfinite(length) ? v / length : otherwise;
}

struct Transform {
    mat4 matrix;
    mat3 normalMatrix;
    bool mirrored;

    explicit Transform(const mat4& m)
        : matrix(m), normalMatrix(cofactor(mat3(m))), mirrored(glm::determinant(mat3(m)) < 0.0f) {
        if (mirrored) normalMatrix = -normalMatrix;
    }
    vec3 point(const vec3& p) const { return vec3(matrix * vec4(p, 1.0f)); }
    vec3 normal(const vec3& n) const { return safeNormalize(normalMatrix * n, vec3(0, 0, 1)); }
    vec3 direction(const vec3& d) const { return safeNormalize(mat3(matrix) * d, vec3(1, 0, 0)); }

    /// The inverse transpose times the determinant: right for normals even where the inverse does not exist.
    static mat3 cofactor(const mat3& m) {
        return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
    }
};

class GeometryPacker {
  public:
    GeometryPacker(const Scene& scene, SceneData& data) : scene_(scene), data_(data) {}

    void pack() {
        findInstancedMeshes();
        data_.instances.resize(scene_.instances.size() * layout::INSTANCE_TEXELS);
        meshFirstTriangle_.assign(scene_.meshes.size(), layout::NONE);
        for (uint32_t i = 0; i < scene_.instances.size(); ++i) packInstance(i);
        data_.features.twoLevel = std::find(instanced_.begin(), instanced_.end(), true) != instanced_.end();
        if (data_.features.twoLevel) {
            packTwoLevels();
        } else {
            const Tree tree = appendTree(staticBoxes_, staticTriangles_);
            data_.params.rootNode = tree.root;
            data_.stackSize = tree.stackSize + 1;
            bounds_ = tree.bounds;
        }
        data_.params.sceneCenter = bounds_.empty() ? vec3(0.0f) : bounds_.center();
        data_.params.sceneRadius =
            bounds_.empty() ? 1.0f : std::max(0.5f * glm::length(bounds_.size()), 1e-20f);
    }

  private:
    struct LeafTriangle {
        vec3 v[3];
        uint32_t primitive, instance, shadingTriangle;
    };
    struct Tree {
        uint32_t root, stackSize;
        Aabb bounds;
    };

    void findInstancedMeshes() {
        std::vector<size_t> uses(scene_.meshes.size(), 0);
        for (const Instance& instance : scene_.instances) ++uses[static_cast<size_t>(instance.mesh)];
        instanced_.resize(scene_.meshes.size());
        for (size_t i = 0; i < uses.size(); ++i) {
            instanced_[i] = uses[i] > 1 && uses[i] * scene_.meshes[i].triangleCount() > mergeLimit;
        }
    }

    uint32_t alphaFlag(const Mesh& mesh, const Instance& instance, size_t triangle) const {
        const size_t slot = mesh.materialSlots.empty() ? 0 : mesh.materialSlots[triangle];
        const Material& material = scene_.materials[static_cast<size_t>(instance.material) + slot];
        return material.alphaMode == AlphaMode::Opaque ? 0 : layout::BVH_TRIANGLE_ALPHA;
    }

    void packInstance(uint32_t index) {
        const Instance& instance = scene_.instances[index];
        const auto meshIndex = static_cast<size_t>(instance.mesh);
        const Mesh& mesh = scene_.meshes[meshIndex];
        const Transform transform(instance.transform);
        data_.features.mirrored |= transform.mirrored;
        uint32_t firstTriangle = meshFirstTriangle_[meshIndex];
        if (!instanced_[meshIndex]) {
            firstTriangle = packShading(mesh, transform, static_cast<uint32_t>(instance.material));
            for (size_t t = 0; t < mesh.triangleCount(); ++t) {
                addTriangle(mesh, t, transform, static_cast<uint32_t>(t) | alphaFlag(mesh, instance, t),
                            index, firstTriangle + static_cast<uint32_t>(t), staticBoxes_, staticTriangles_);
            }
        } else if (firstTriangle == layout::NONE) {
            firstTriangle = meshFirstTriangle_[meshIndex] = packShading(mesh, Transform(mat4(1.0f)), 0);
        }
        uvec4* record = &data_.instances[size_t{index} * layout::INSTANCE_TEXELS];
        packRows(record, instance.transform);
        record[3] = {static_cast<uint32_t>(instance.material), layout::NONE, firstTriangle,
                     transform.mirrored ? layout::INSTANCE_MIRRORED : 0u};
    }

    static void packRows(uvec4* record, const mat4& m) {
        for (int row = 0; row < 3; ++row)
            record[row] = bits(vec3(m[0][row], m[1][row], m[2][row]), m[3][row]);
    }

    void addTriangle(const Mesh& mesh, size_t triangle, const Transform& transform, uint32_t primitive,
                     uint32_t instance, uint32_t shadingTriangle, std::vector<Aabb>& boxes,
                     std::vector<LeafTriangle>& triangles) {
        LeafTriangle leaf{{}, primitive, instance, shadingTriangle};
        Aabb box;
        for (size_t corner = 0; corner < 3; ++corner) {
            leaf.v[corner] = transform.point(mesh.positions[mesh.indices[3 * triangle + corner]]);
            box.grow(leaf.v[corner]);
        }
        boxes.push_back(box);
        triangles.push_back(leaf);
    }

    /// Appends vertices and shading triangles, transformed; returns the first triangle's index.
    uint32_t packShading(const Mesh& mesh, const Transform& transform, uint32_t material) {
        const auto firstVertex = static_cast<uint32_t>(data_.vertices.size() / layout::VERTEX_TEXELS);
        const auto firstTriangle = static_cast<uint32_t>(data_.triangles.size());
        if (data_.features.vertexData) {
            for (size_t v = 0; v < mesh.positions.size(); ++v) packVertex(mesh, v, transform);
        }
        const uint32_t flags = mesh.normals.empty() ? 0 : layout::TRIANGLE_SMOOTH;
        for (size_t t = 0; t < mesh.triangleCount(); ++t) {
            const uint32_t slot = mesh.materialSlots.empty() ? 0 : mesh.materialSlots[t];
            data_.triangles.emplace_back(firstVertex + mesh.indices[3 * t],
                                         firstVertex + mesh.indices[3 * t + 1],
                                         firstVertex + mesh.indices[3 * t + 2], (material + slot) | flags);
        }
        return firstTriangle;
    }

    void packVertex(const Mesh& mesh, size_t v, const Transform& transform) {
        const vec3 normal = mesh.normals.empty() ? vec3(0, 0, 1) : transform.normal(mesh.normals[v]);
        const vec4 tangent = mesh.tangents.empty() ? vec4(1, 0, 0, 1) : mesh.tangents[v];
        uint32_t tangentBits = packDirection(transform.direction(vec3(tangent))) & ~1u;
        // A mirroring transform turns the handedness of the tangent frame.
        if ((tangent.w < 0.0f) != transform.mirrored) tangentBits |= 1u;
        const vec2 uv0 = mesh.uv0.empty() ? vec2(0.0f) : mesh.uv0[v];
        const vec2 uv1 = mesh.uv1.empty() ? vec2(0.0f) : mesh.uv1[v];
        const vec4 color = mesh.colors.empty() ? vec4(1.0f) : glm::clamp(mesh.colors[v], 0.0f, 1.0f);
        data_.vertices.emplace_back(packDirection(normal), tangentBits, bits(uv0.x), bits(uv0.y));
        data_.vertices.emplace_back(bits(uv1.x), bits(uv1.y), glm::packUnorm2x16({color.r, color.g}),
                                    glm::packUnorm2x16({color.b, color.a}));
    }

    /// Builds a tree and appends it to the node and triangle buffers.
    Tree appendTree(const std::vector<Aabb>& boxes, const std::vector<LeafTriangle>& triangles) {
        const Bvh bvh = buildBvh(boxes, maxTrianglesPerLeaf);
        const auto firstTriangle =
            static_cast<uint32_t>(data_.bvhTriangles.size() / layout::BVH_TRIANGLE_TEXELS);
        if (firstTriangle + triangles.size() > BvhRef::maxIndex) {
            throw Error(fmt::format("the scene has more than {} triangles", BvhRef::maxIndex));
        }
        const uint32_t root = appendNodes(bvh, firstTriangle);
        data_.bvhTriangles.reserve(data_.bvhTriangles.size() +
                                   triangles.size() * layout::BVH_TRIANGLE_TEXELS);
        for (const uint32_t index : bvh.order) {
            const LeafTriangle& t = triangles[index];
            data_.bvhTriangles.emplace_back(t.v[0], std::bit_cast<float>(t.primitive));
            data_.bvhTriangles.emplace_back(t.v[1], std::bit_cast<float>(t.instance));
            data_.bvhTriangles.emplace_back(t.v[2], std::bit_cast<float>(t.shadingTriangle));
        }
        return {root, bvh.stackSize, bvh.bounds};
    }

    uint32_t appendNodes(const Bvh& bvh, uint32_t firstLeaf) {
        const auto root = static_cast<uint32_t>(data_.bvhNodes.size() / layout::BVH_NODE_TEXELS);
        data_.bvhNodes.reserve(data_.bvhNodes.size() + bvh.nodes.size() * layout::BVH_NODE_TEXELS);
        for (BvhNode node : bvh.nodes) {
            for (uint32_t& child : node.children) child += BvhRef::isLeaf(child) ? firstLeaf : root;
            const auto texels = std::bit_cast<std::array<uvec4, layout::BVH_NODE_TEXELS>>(node);
            data_.bvhNodes.insert(data_.bvhNodes.end(), texels.begin(), texels.end());
        }
        return root;
    }

    /// A tree over the static tree and every instance of the instanced meshes.
    void packTwoLevels() {
        std::vector<Aabb> boxes;
        uint32_t deepest = 0;
        const auto addLeaf = [&](const Tree& tree, const mat4& toWorld, uint32_t instance) {
            const size_t at = data_.bvhInstances.size();
            data_.bvhInstances.resize(at + layout::BVH_INSTANCE_TEXELS);
            packRows(&data_.bvhInstances[at], glm::inverse(toWorld));
            data_.bvhInstances[at + 3] = {tree.root, instance, 0, 0};
            boxes.push_back(transformed(tree.bounds, toWorld));
            deepest = std::max(deepest, tree.stackSize);
        };
        if (!staticBoxes_.empty())
            addLeaf(appendTree(staticBoxes_, staticTriangles_), mat4(1.0f), layout::NONE);
        std::vector<std::optional<Tree>> trees(scene_.meshes.size());
        for (uint32_t i = 0; i < scene_.instances.size(); ++i) {
            const Instance& instance = scene_.instances[i];
            const auto mesh = static_cast<size_t>(instance.mesh);
            if (!instanced_[mesh] || !isInvertible(instance.transform)) continue;
            if (!trees[mesh]) trees[mesh] = appendMeshTree(mesh);
            addLeaf(*trees[mesh], instance.transform, i);
        }
        const Bvh top = buildBvh(boxes, 1);
        reorder(top.order);
        data_.params.rootNode = appendNodes(top, 0);
        data_.stackSize = top.stackSize + deepest + 3;
        bounds_ = top.bounds;
    }

    /// An instance squeezed to a plane or a line shows nothing that a ray could meet robustly.
    static bool isInvertible(const mat4& m) {
        const float determinant = std::abs(glm::determinant(mat3(m)));
        return determinant > std::numeric_limits<float>::min() && std::isfinite(1.0f / determinant);
    }

    Tree appendMeshTree(size_t meshIndex) {
        const Mesh& mesh = scene_.meshes[meshIndex];
        std::vector<Aabb> boxes;
        std::vector<LeafTriangle> triangles;
        for (uint32_t t = 0; t < mesh.triangleCount(); ++t) {
            uint32_t flag = 0;
            for (const Instance& instance : scene_.instances) {
                if (static_cast<size_t>(instance.mesh) == meshIndex) flag |= alphaFlag(mesh, instance, t);
            }
            addTriangle(mesh, t, Transform(mat4(1.0f)), t | flag, layout::NONE,
                        meshFirstTriangle_[meshIndex] + t, boxes, triangles);
        }
        return appendTree(boxes, triangles);
    }

    static Aabb transformed(const Aabb& box, const mat4& m) {
        Aabb result;
        for (int corner = 0; corner < 8; ++corner) {
            const vec3 p(corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                         corner & 4 ? box.upper.z : box.lower.z);
            result.grow(vec3(m * vec4(p, 1.0f)));
        }
        // Rays meet the instance in its own space; their rounding there must not exceed its box here.
        const vec3 margin = 1e-5f * (glm::abs(result.lower) + glm::abs(result.upper) + result.size());
        result.lower -= margin;
        result.upper += margin;
        return result;
    }

    /// Leaves of the top tree name their instance directly, so the records take the tree's order.
    void reorder(const std::vector<uint32_t>& order) {
        std::vector<uvec4> sorted;
        sorted.reserve(data_.bvhInstances.size());
        for (const uint32_t index : order) {
            const auto record = data_.bvhInstances.begin() + size_t{index} * layout::BVH_INSTANCE_TEXELS;
            sorted.insert(sorted.end(), record, record + layout::BVH_INSTANCE_TEXELS);
        }
        data_.bvhInstances = std::move(sorted);
    }

    const Scene& scene_;
    SceneData& data_;
    std::vector<bool> instanced_;
    std::vector<uint32_t> meshFirstTriangle_;
    std::vector<Aabb> staticBoxes_;
    std::vector<LeafTriangle> staticTriangles_;
    Aabb bounds_;
};

}  // namespace

void packGeometry(const Scene& scene, SceneData& data) {
    GeometryPacker(scene, data).pack();
}

}  // namespace limpid::scene
