// Binary trees cut into subtrees, each of which one thread can work on.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/device/trees/binary_tree.h"

namespace limpid::scene {

struct Cut {
    BinaryTree top;               ///< `primitive` of a leaf: index of its subtree
    std::vector<uint32_t> roots;  ///< of the subtrees, in the whole tree
};

/// Cuts off the largest subtrees of up to `most` leaves, on all cores.
Cut cutTree(const BinaryTree& tree, uint32_t most);

/// A copy of the tree below a node, in the order of a traversal and without gaps. Leaves stay as they are.
BinaryTree subtreeOf(const BinaryTree& tree, uint32_t root);

}  // namespace limpid::scene
