#include "scene/device/trees/top_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "scene/device/pack.h"
#include "scene/model/transform.h"

namespace limpid::scene {

uint32_t topStackLimit(size_t leaves) {
    // Splitting in halves gives a binary tree of this depth; every wide level needs at most three entries.
    return 3 * (static_cast<uint32_t>(std::bit_width(std::max<size_t>(leaves, 1))) + 1);
}

TopTree buildTopTree(std::span<const TopLeaf> leaves, uint32_t firstNode, uint32_t maxStack) {
    std::vector<Aabb> boxes;
    std::vector<uint32_t> records;
    for (const TopLeaf& leaf : leaves) {
        if (leaf.bounds.empty()) continue;
        boxes.push_back(leaf.bounds);
        records.push_back(leaf.record);
    }
    Bvh bvh = buildBvh(boxes, 1);
    if (bvh.stackSize > maxStack) bvh = buildBvh(boxes, 1, 0);
    for (BvhNode& node : bvh.nodes) {
        for (uint32_t& child : node.children) {
            if (BvhRef::isLeaf(child)) {
                const uint32_t slot = BvhRef::first(child);
                child = BvhRef::leaf(records.empty() ? 0 : records[bvh.order[slot]], 1);
            } else {
                child += firstNode;
            }
        }
    }
    return {std::move(bvh.nodes), bvh.stackSize, bvh.bounds};
}

Aabb transformed(const Aabb& box, const mat4& m) {
    Aabb result;
    if (box.empty()) return result;
    for (int i = 0; i < 8; ++i) result.grow(transformPoint(m, box.corner(i)));
    // Rays are intersected in the instance's own space; the rounding there must not exceed the box here.
    const vec3 margin = 1e-5f * (glm::abs(result.lower) + glm::abs(result.upper) + result.size());
    result.lower -= margin;
    result.upper += margin;
    return result;
}

bool isInvertible(const mat4& m) {
    const float determinant = std::abs(glm::determinant(mat3(m)));
    return determinant > std::numeric_limits<float>::min() && std::isfinite(1.0f / determinant) &&
           std::isfinite(determinant);
}

void packRows(uvec4* rows, const mat4& m) {
    for (int row = 0; row < 3; ++row) rows[row] = bits(vec3(m[0][row], m[1][row], m[2][row]), m[3][row]);
}

}  // namespace limpid::scene
