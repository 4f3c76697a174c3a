// The tree over trees: its leaves are placed meshes. What moves has a tree of its own beside what stays, so
// that a frame rebuilds no more than what moved.
#pragma once

#include <span>
#include <vector>

#include "scene/device/bvh.h"
#include "shaders/common/scene_layout.h"

namespace limpid::scene {

/// A record of bvhInstances and its box in the world; an empty box keeps it out of the tree.
struct TopLeaf {
    uint32_t record = 0;
    Aabb bounds;
};

struct TopTree {
    std::vector<BvhNode> nodes;  ///< the root is the first; at most max(1, leaves - 1)
    uint32_t stackSize = 0;
    Aabb bounds;
};

/// Its nodes will lie at `firstNode` and after. If traversal would need more than `maxStack` entries, a
/// shallower tree of lower quality is made; topStackLimit() is always enough.
TopTree buildTopTree(std::span<const TopLeaf> leaves, uint32_t firstNode, uint32_t maxStack = UINT32_MAX);
uint32_t topStackLimit(size_t leaves);

/// The box of a transformed box, widened by what rounding in the instance's own space may add.
Aabb transformed(const Aabb& box, const mat4& m);
/// An instance squeezed to a plane or a line shows nothing that a ray could meet robustly.
bool isInvertible(const mat4& m);
/// Three rows of an affine matrix.
void packRows(uvec4* rows, const mat4& m);

}  // namespace limpid::scene
