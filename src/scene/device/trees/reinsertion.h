// Makes a tree better by moving its nodes: D. Meister, J. Bittner, "Parallel Reinsertion for Bounding Volume
// Hierarchy Optimization", Eurographics 2018.
#pragma once

#include "base/progress.h"
#include "scene/device/trees/binary_tree.h"

namespace limpid::scene {

/// Lowers the sum of the areas of all nodes, on all cores: each of at most so many rounds looks for better
/// places of a fifth of the nodes. The result depends on the arguments alone. Throws Cancelled as `progress`
/// does.
void reinsert(BinaryTree& tree, uint32_t rounds, const Progress& progress);

}  // namespace limpid::scene
