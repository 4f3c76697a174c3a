// Which nodes of a binary tree become children of wide nodes, and which leaves, so that rays cost least: the
// dynamic programme of H. Ylitie, T. Karras, S. Laine, "Efficient incoherent ray traversal on GPUs through
// compressed wide BVHs", HPG 2017, section 3.1.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/device/trees/binary_tree.h"

namespace limpid::scene {

class Collapse {
  public:
    static constexpr uint32_t width = 4;

    /// Keeps a reference to the tree.
    Collapse(const BinaryTree& tree, uint32_t maxLeafSize);

    const BinaryTree& tree() const { return tree_; }

    /// The children of the wide node that a binary node becomes: one to `width` nodes below it, or itself if
    /// it is a leaf.
    std::vector<uint32_t> childrenOf(uint32_t node) const;
    /// Of a child: it becomes a leaf with all primitives below it, at most maxLeafSize.
    bool becomesLeaf(uint32_t node) const { return best_[node].leaf; }

  private:
    struct Best {
        std::array<float, width - 1> costs;  ///< of a subtree that becomes at most 1, 2, ... children
        uint32_t count : 31;                 ///< of primitives
        uint32_t leaf : 1;
    };

    void solve(uint32_t node);
    float shared(const BinaryNode& node, uint32_t slots, uint32_t left) const;
    uint32_t bestShare(const BinaryNode& node, uint32_t slots) const;
    void collect(uint32_t node, uint32_t slots, std::vector<uint32_t>& children) const;
    void share(uint32_t node, uint32_t slots, std::vector<uint32_t>& children) const;

    const BinaryTree& tree_;
    uint32_t maxLeafSize_;
    RawVector<Best> best_;
};

}  // namespace limpid::scene
