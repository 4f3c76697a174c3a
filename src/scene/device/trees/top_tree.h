// The top-level tree, whose leaves are placed meshes. Moving instances have a tree of their own, separate
// from static ones, so that a frame only rebuilds what moved.
#pragma once

#include <span>
#include <vector>

#include "scene/device/trees/bvh.h"
#include "shaders/common/scene_layout.h"

namespace limpid::scene {

/// A record of bvhInstances and its box in world space; an empty box excludes it from the tree.
struct TopLeaf {
    uint32_t record = 0;
    Aabb bounds;
};

struct TopTree {
    RawVector<BvhNode> nodes;  ///< the root is the first; at most max(1, leaves - 1)
    uint32_t stackSize = 0;
    Aabb bounds;
};

/// The nodes will be stored from index `firstNode` on. If traversal would need more than `maxStack` entries,
/// builds a shallower tree of lower quality; topStackLimit() is always enough.
TopTree buildTopTree(std::span<const TopLeaf> leaves, uint32_t firstNode, uint32_t maxStack = UINT32_MAX);
uint32_t topStackLimit(size_t leaves);

/// Returns the box of a transformed box, widened by the possible rounding error in the instance's space.
Aabb transformed(const Aabb& box, const mat4& m);
/// False for an instance flattened to a plane or a line, which rays cannot hit robustly.
bool isInvertible(const mat4& m);
/// Packs three rows of an affine matrix.
void packRows(uvec4* rows, const mat4& m);

}  // namespace limpid::scene
