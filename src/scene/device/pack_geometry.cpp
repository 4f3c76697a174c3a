#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <optional>
#include <span>

#include "base/error.h"
#include "base/for_each_index.h"
#include "scene/device/pack.h"
#include "scene/device/trees/top_tree.h"
#include "scene/model/transform.h"

namespace limpid::scene {
namespace {

/// A mesh whose copies have at most this many triangles in total is copied into the static tree instead of
/// instanced, since one tree is traversed faster than two levels.
constexpr size_t mergeLimit = 4096;

/// Normalises a vector; returns `otherwise` if it is degenerate.
vec3 safeNormalize(const vec3& v, const vec3& otherwise) {
    const float length = glm::length(v);
    return length > 1e-20f && std::isfinite(length) ? v / length : otherwise;
}

/// Transforms normals and tangents.
struct Transform {
    mat4 matrix;
    mat3 normalMatrix;
    bool mirrored;

    explicit Transform(const mat4& m)
        : matrix(m), normalMatrix(cofactor(mat3(m))), mirrored(glm::determinant(mat3(m)) < 0.0f) {
        if (mirrored) normalMatrix = -normalMatrix;
    }
    vec3 normal(const vec3& n) const { return safeNormalize(normalMatrix * n, vec3(0, 0, 1)); }
    vec3 direction(const vec3& d) const { return safeNormalize(mat3(matrix) * d, vec3(1, 0, 0)); }

    /// The inverse transpose times the determinant: transforms normals correctly even if there is no inverse.
    static mat3 cofactor(const mat3& m) {
        return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
    }
};

class GeometryPacker {
  public:
    GeometryPacker(const Scene& scene, SceneData& data, const Progress& progress)
        : scene_(scene), data_(data), progress_(progress) {
        for (const Mesh& mesh : scene.meshes) meshTriangles_ += mesh.triangleCount();
    }

    void pack() {
        findInstancedMeshes();
        data_.instances.resize(scene_.instances.size() * layout::INSTANCE_TEXELS);
        meshFirstTriangle_.assign(scene_.meshes.size(), layout::NONE);
        for (uint32_t i = 0; i < scene_.instances.size(); ++i) {
            if (scene_.instances[i].movement == Movement::Deforming) packInstance(i);
        }
        for (uint32_t i = 0; i < scene_.instances.size(); ++i) {
            if (scene_.instances[i].movement != Movement::Deforming) packInstance(i);
        }
        if (isTwoLevel()) {
            data_.features.twoLevel = true;
            packTwoLevels();
        } else {
            const Tree tree = appendTree(static_);
            data_.placements.push_back(placementOf(tree.number, mat4(1.0f)));
            data_.params.rootNode = tree.root;
            data_.stackSize = tree.stackSize + 1;
            bounds_ = tree.bounds;
        }
        data_.params.sceneCenter = bounds_.empty() ? vec3(0.0f) : bounds_.center();
        data_.params.sceneRadius =
            bounds_.empty() ? 1.0f : std::max(0.5f * glm::length(bounds_.size()), 1e-20f);
    }

  private:
    struct TriangleRecord {
        uint32_t primitive, instance, shadingTriangle;
    };
    /// The triangles of one tree.
    struct Triangles {
        /// If all are of one mesh, and stay in its space. Null: records name instances, and corners are in
        /// world space.
        const Mesh* mesh = nullptr;
        RawVector<TriangleRecord> records;
    };
    struct Tree {
        uint32_t root, stackSize;
        Aabb bounds;
        uint32_t number;  ///< index in SceneData::trees
    };

    void findInstancedMeshes() {
        std::vector<size_t> uses(scene_.meshes.size(), 0);
        instanced_.resize(scene_.meshes.size());
        for (const Instance& instance : scene_.instances) {
            const auto mesh = static_cast<size_t>(instance.mesh);
            if (instance.movement == Movement::Rigid) instanced_[mesh] = true;
            if (instance.movement != Movement::Deforming) ++uses[mesh];
            data_.motion.moving |= instance.movement != Movement::Still;
        }
        data_.features.motion = data_.motion.moving;
        for (size_t i = 0; i < uses.size(); ++i) {
            if (uses[i] > 1 && uses[i] * scene_.meshes[i].triangleCount() > mergeLimit) instanced_[i] = true;
        }
    }

    bool isTwoLevel() const {
        return data_.motion.moving ||
               std::find(instanced_.begin(), instanced_.end(), true) != instanced_.end();
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
        // A moving transform may become mirrored later.
        data_.features.mirrored |= transform.mirrored || instance.movement != Movement::Still;
        uint32_t firstTriangle = meshFirstTriangle_[meshIndex];
        uint32_t flags = transform.mirrored ? layout::INSTANCE_MIRRORED : 0u;
        const bool hasTree = instance.movement == Movement::Deforming || instanced_[meshIndex];
        if (hasTree) flags |= layout::INSTANCE_HAS_TREE;
        if (instance.movement == Movement::Deforming) {
            firstTriangle = packDeforming(index, mesh);
            flags |= layout::INSTANCE_DEFORMING;
        } else if (!hasTree) {
            firstTriangle = packShading(mesh, transform, static_cast<uint32_t>(instance.material));
            addTriangles(mesh, index, firstTriangle, static_,
                         [&](uint32_t t) { return alphaFlag(mesh, instance, t); });
        } else if (firstTriangle == layout::NONE) {
            firstTriangle = meshFirstTriangle_[meshIndex] = packShading(mesh, Transform(mat4(1.0f)), 0);
        }
        uvec4* record = &data_.instances[size_t{index} * layout::INSTANCE_TEXELS];
        packRows(record, instance.transform);
        record[3] = {static_cast<uint32_t>(instance.material), layout::NONE, firstTriangle, flags};
    }

    /// Packs the instance's own vertices and triangles, and the data that poses them.
    uint32_t packDeforming(uint32_t index, const Mesh& mesh) {
        const uint32_t firstVertex = vertexCount_;
        const uint32_t firstTriangle = packShading(mesh, Transform(mat4(1.0f)), 0);
        data_.motion.deforming.push_back(packDeformation(scene_, index, firstVertex, data_.motion));
        return firstTriangle;
    }

    /// Adds all triangles of a mesh. `flag` returns the alpha flag of a triangle.
    template <typename Flag>
    static void addTriangles(const Mesh& mesh, uint32_t instance, uint32_t firstTriangle,
                             Triangles& triangles, const Flag& flag) {
        const size_t first = triangles.records.size();
        triangles.records.resize(first + mesh.triangleCount());
        forEachIndex(mesh.triangleCount(), [&](size_t i) {
            const auto t = static_cast<uint32_t>(i);
            triangles.records[first + i] = {t | flag(t), instance, firstTriangle + t};
        });
    }

    Corners cornersOf(const Triangles& triangles, size_t index) const {
        const TriangleRecord& record = triangles.records[index];
        const Mesh* mesh = triangles.mesh;
        mat4 toSpace(1.0f);
        if (!mesh) {
            const Instance& instance = scene_.instances[record.instance];
            mesh = &scene_.meshes[static_cast<size_t>(instance.mesh)];
            toSpace = instance.transform;
        }
        const size_t first = size_t{3} * (record.primitive & ~layout::BVH_TRIANGLE_ALPHA);
        Corners corners;
        for (size_t i = 0; i < 3; ++i)
            corners[i] = transformPoint(toSpace, mesh->positions[mesh->indices[first + i]]);
        return corners;
    }

    /// Appends transformed vertices and shading triangles; returns the first triangle's index.
    uint32_t packShading(const Mesh& mesh, const Transform& transform, uint32_t material) {
        const uint32_t firstVertex = vertexCount_;
        vertexCount_ += static_cast<uint32_t>(mesh.positions.size());
        const auto firstTriangle = static_cast<uint32_t>(data_.triangles.size());
        if (data_.features.vertexData) {
            const size_t first = data_.vertices.size();
            data_.vertices.resize(first + 2 * mesh.positions.size());
            forEachIndex(mesh.positions.size(),
                         [&](size_t v) { packVertex(mesh, v, transform, &data_.vertices[first + 2 * v]); });
        }
        const uint32_t flags = mesh.normals.empty() ? 0 : layout::TRIANGLE_SMOOTH;
        data_.triangles.resize(firstTriangle + mesh.triangleCount());
        forEachIndex(mesh.triangleCount(), [&](size_t t) {
            const uint32_t slot = mesh.materialSlots.empty() ? 0 : mesh.materialSlots[t];
            data_.triangles[firstTriangle + t] = {
                firstVertex + mesh.indices[3 * t], firstVertex + mesh.indices[3 * t + 1],
                firstVertex + mesh.indices[3 * t + 2], (material + slot) | flags};
        });
        return firstTriangle;
    }

    /// Writes two texels.
    static void packVertex(const Mesh& mesh, size_t v, const Transform& transform, uvec4* out) {
        const vec3 normal = mesh.normals.empty() ? vec3(0, 0, 1) : transform.normal(mesh.normals[v]);
        const vec4 tangent = mesh.tangents.empty() ? vec4(1, 0, 0, 1) : mesh.tangents[v];
        uint32_t tangentBits = packDirection(transform.direction(vec3(tangent))) & ~1u;
        // A mirroring transform changes the handedness of the tangent frame.
        if ((tangent.w < 0.0f) != transform.mirrored) tangentBits |= 1u;
        const vec2 uv0 = mesh.uv0.empty() ? vec2(0.0f) : mesh.uv0[v];
        const vec2 uv1 = mesh.uv1.empty() ? vec2(0.0f) : mesh.uv1[v];
        const vec4 color = mesh.colors.empty() ? vec4(1.0f) : glm::clamp(mesh.colors[v], 0.0f, 1.0f);
        out[0] = {packDirection(normal), tangentBits, bits(uv0.x), bits(uv0.y)};
        out[1] = {bits(uv1.x), bits(uv1.y), glm::packUnorm2x16({color.r, color.g}),
                  glm::packUnorm2x16({color.b, color.a})};
    }

    /// Large trees are built without an array of all corners, which would be a quarter of the memory.
    Bvh buildTree(const Triangles& triangles, const std::vector<bool>& divisible) {
        const size_t count = triangles.records.size();
        const Progress progress = progressOf(count);
        if (count <= maxSplitTriangles) {
            RawVector<Corners> corners(count);
            forEachIndex(count, [&](size_t i) { corners[i] = cornersOf(triangles, i); });
            return buildTriangleBvh(corners, divisible, progress);
        }
        References references(count);
        forEachIndex(count, [&](size_t i) {
            references[i] = {boxOf(cornersOf(triangles, i)), static_cast<uint32_t>(i)};
        });
        return buildTriangleBvh(std::move(references), progress);
    }

    /// Builds a tree and appends it to the node and triangle buffers.
    Tree appendTree(const Triangles& triangles, bool moves = false) {
        const std::vector<bool> isOpaque = opaqueOnes(triangles);
        Bvh bvh = buildTree(triangles, moves ? std::vector<bool>(isOpaque.size()) : isOpaque);
        const auto firstTriangle =
            static_cast<uint32_t>(data_.bvhTriangles.size() / layout::BVH_TRIANGLE_TEXELS);
        if (firstTriangle + bvh.order.size() > BvhRef::maxIndex) {
            throw Error(fmt::format("the scene has more than {} triangles", BvhRef::maxIndex));
        }
        const uint32_t root = appendNodes(bvh.nodes, [&](uint32_t child, uint32_t firstNode) {
            return child + (BvhRef::isLeaf(child) ? firstTriangle : firstNode);
        });
        bvh.nodes = RawVector<BvhNode>();  // frees them, which {} would not
        noteRepeated(bvh.order, isOpaque.size(), firstTriangle);
        data_.bvhTriangles.resize(data_.bvhTriangles.size() + bvh.order.size() * layout::BVH_TRIANGLE_TEXELS);
        forEachIndex(bvh.order.size(), [&](size_t i) {
            const auto [a, b, c] = cornersOf(triangles, bvh.order[i]);
            const TriangleRecord& record = triangles.records[bvh.order[i]];
            vec4* out = &data_.bvhTriangles[(firstTriangle + i) * layout::BVH_TRIANGLE_TEXELS];
            out[0] = vec4(a, std::bit_cast<float>(record.primitive));
            out[1] = vec4(b, std::bit_cast<float>(record.instance));
            out[2] = vec4(c, std::bit_cast<float>(record.shadingTriangle));
        });
        const bool opaque = std::find(isOpaque.begin(), isOpaque.end(), false) == isOpaque.end();
        data_.trees.push_back({firstTriangle, static_cast<uint32_t>(bvh.order.size()), opaque, moves});
        return {root, bvh.stackSize, bvh.bounds, static_cast<uint32_t>(data_.trees.size() - 1)};
    }

    /// Where a tree's leaves have a triangle for the second time.
    void noteRepeated(std::span<const uint32_t> order, size_t triangles, uint32_t firstTriangle) {
        if (order.size() == triangles) return;
        std::vector<bool> placed(triangles);
        for (uint32_t i = 0; i < order.size(); ++i) {
            if (placed[order[i]]) data_.repeatedTriangles.push_back(firstTriangle + i);
            placed[order[i]] = true;
        }
    }

    /// By triangle. Others are not split: each part would decide at random for itself whether a ray passes.
    static std::vector<bool> opaqueOnes(const Triangles& triangles) {
        std::vector<bool> opaque(triangles.records.size());
        for (size_t i = 0; i < opaque.size(); ++i)
            opaque[i] = (triangles.records[i].primitive & layout::BVH_TRIANGLE_ALPHA) == 0;
        return opaque;
    }

    /// For the next tree. Meshes that are copied into one tree count more than once, so the shares are rough.
    Progress progressOf(size_t triangles) {
        const auto share = [&] {
            return std::min(static_cast<double>(treeTriangles_) /
                                static_cast<double>(std::max<size_t>(meshTriangles_, 1)),
                            1.0);
        };
        const double from = share();
        treeTriangles_ += triangles;
        return progress_.part(from, share());
    }

    template <typename Rebase>
    uint32_t appendNodes(std::span<const BvhNode> nodes, const Rebase& rebase) {
        const uint32_t root = nodeCount();
        data_.bvhNodes.reserve(data_.bvhNodes.size() + nodes.size() * layout::BVH_NODE_TEXELS);
        for (BvhNode node : nodes) {
            for (uint32_t& child : node.children) child = rebase(child, root);
            const auto texels = std::bit_cast<std::array<uvec4, layout::BVH_NODE_TEXELS>>(node);
            data_.bvhNodes.insert(data_.bvhNodes.end(), texels.begin(), texels.end());
        }
        return root;
    }

    uint32_t nodeCount() const {
        return static_cast<uint32_t>(data_.bvhNodes.size() / layout::BVH_NODE_TEXELS);
    }

    /// Builds the static tree, a tree per instanced mesh, and a top-level tree over all instances.
    void packTwoLevels() {
        packPreviousInstances();
        if (!static_.records.empty()) {
            const Tree tree = appendTree(static_);
            still_.push_back({addRecord(tree, mat4(1.0f), layout::NONE), tree.bounds});
        }
        packMeshInstances();
        packDeformingTrees();
        const TopTree top = buildTopTree(still_, nodeCount());
        const auto keep = [](uint32_t child, uint32_t) { return child; };
        data_.motion.stillRoot = data_.params.rootNode = appendNodes(top.nodes, keep);
        data_.motion.stillBounds = bounds_ = top.bounds;
        data_.stackSize = top.stackSize + deepest_ + 3;
        if (data_.motion.moving) reserveMovingTree(top.stackSize);
    }

    uint32_t addRecord(const Tree& tree, const mat4& toWorld, uint32_t instance) {
        const size_t at = data_.bvhInstances.size();
        data_.bvhInstances.resize(at + layout::BVH_INSTANCE_TEXELS);
        packRows(&data_.bvhInstances[at], isInvertible(toWorld) ? glm::inverse(toWorld) : mat4(1.0f));
        data_.bvhInstances[at + 3] = {tree.root, instance, data_.trees[tree.number].first, 0};
        data_.placements.push_back(placementOf(tree.number, toWorld));
        deepest_ = std::max(deepest_, tree.stackSize);
        return static_cast<uint32_t>(at / layout::BVH_INSTANCE_TEXELS);
    }

    void packMeshInstances() {
        std::vector<std::optional<Tree>> trees(scene_.meshes.size());
        for (uint32_t i = 0; i < scene_.instances.size(); ++i) {
            const Instance& instance = scene_.instances[i];
            const auto mesh = static_cast<size_t>(instance.mesh);
            if (instance.movement == Movement::Deforming || !instanced_[mesh]) continue;
            const bool moves = instance.movement == Movement::Rigid;
            if (!moves && !isInvertible(instance.transform)) continue;
            if (!trees[mesh]) trees[mesh] = appendMeshTree(mesh);
            const uint32_t record = addRecord(*trees[mesh], instance.transform, i);
            if (moves) {
                data_.motion.leaves.push_back(
                    {i, record, trees[mesh]->root, trees[mesh]->number, trees[mesh]->bounds});
            } else {
                still_.push_back({record, transformed(trees[mesh]->bounds, instance.transform)});
            }
        }
    }

    void packDeformingTrees() {
        MotionData& motion = data_.motion;
        motion.firstRefitNode = nodeCount();
        for (DeformingInstance& deforming : motion.deforming) {
            const Instance& instance = scene_.instances[deforming.instance];
            const Mesh& mesh = scene_.meshes[static_cast<size_t>(instance.mesh)];
            const uint32_t firstTriangle =
                data_.instances[size_t{deforming.instance} * layout::INSTANCE_TEXELS + 3].z;
            Triangles triangles{&mesh, {}};
            addTriangles(mesh, layout::NONE, firstTriangle, triangles,
                         [&](uint32_t t) { return alphaFlag(mesh, instance, t); });
            const Tree tree = appendTree(triangles, true);
            deforming.leaf = static_cast<uint32_t>(motion.leaves.size());
            const uint32_t record = addRecord(tree, instance.transform, deforming.instance);
            motion.leaves.push_back({deforming.instance, record, tree.root, tree.number, tree.bounds});
        }
        motion.refitNodeCount = nodeCount() - motion.firstRefitNode;
        findRefitLevels(data_);
    }

    /// Reserves space for the nodes that are written in every frame.
    void reserveMovingTree(uint32_t stillStack) {
        MotionData& motion = data_.motion;
        motion.firstTopNode = data_.params.rootNode = nodeCount();
        motion.topStack = topStackLimit(motion.leaves.size());
        const size_t nodes = 1 + std::max<size_t>(motion.leaves.size(), 1);
        data_.bvhNodes.resize(data_.bvhNodes.size() + nodes * layout::BVH_NODE_TEXELS);
        data_.stackSize = std::max(stillStack, motion.topStack) + deepest_ + 6;
        for (const MovingLeaf& leaf : motion.leaves)
            bounds_.grow(transformed(leaf.bounds, scene_.instances[leaf.instance].transform));
    }

    void packPreviousInstances() {
        if (!data_.motion.moving) return;
        const size_t count = scene_.instances.size();
        data_.previousGeometry.resize(count * layout::PREVIOUS_INSTANCE_TEXELS);
        for (size_t i = 0; i < count; ++i) {
            packRows(&data_.previousGeometry[i * layout::PREVIOUS_INSTANCE_TEXELS],
                     scene_.instances[i].transform);
        }
        data_.params.previousVertexBase = static_cast<uint32_t>(data_.previousGeometry.size());
        for (const DeformingInstance& deforming : data_.motion.deforming)
            data_.previousGeometry.resize(data_.previousGeometry.size() + deforming.vertexCount);
    }

    Tree appendMeshTree(size_t meshIndex) {
        const Mesh& mesh = scene_.meshes[meshIndex];
        Triangles triangles{&mesh, {}};
        std::vector<const Instance*> uses;
        for (const Instance& instance : scene_.instances) {
            if (static_cast<size_t>(instance.mesh) == meshIndex) uses.push_back(&instance);
        }
        addTriangles(mesh, layout::NONE, meshFirstTriangle_[meshIndex], triangles, [&](uint32_t t) {
            uint32_t flag = 0;
            for (const Instance* instance : uses) flag |= alphaFlag(mesh, *instance, t);
            return flag;
        });
        return appendTree(triangles);
    }

    const Scene& scene_;
    SceneData& data_;
    Progress progress_;
    size_t meshTriangles_ = 0, treeTriangles_ = 0;
    std::vector<bool> instanced_;  ///< by mesh
    std::vector<TopLeaf> still_;
    uint32_t vertexCount_ = 0;
    uint32_t deepest_ = 0;  ///< stack entries of the deepest tree below the top level
    std::vector<uint32_t> meshFirstTriangle_;
    Triangles static_;  ///< of all meshes that do not move and are placed once
    Aabb bounds_;
};

}  // namespace

gpu::TreePlacement placementOf(uint32_t tree, const mat4& toWorld) {
    gpu::TreePlacement placement{.tree = tree, .visible = isInvertible(toWorld)};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column)
            placement.toWorld[static_cast<size_t>(4 * row + column)] = toWorld[column][row];
    }
    return placement;
}

void packGeometry(const Scene& scene, SceneData& data, const Progress& progress) {
    GeometryPacker(scene, data, progress).pack();
}

}  // namespace limpid::scene
