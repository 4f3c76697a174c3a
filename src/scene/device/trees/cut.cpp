#include "scene/device/trees/cut.h"

#include <tbb/parallel_invoke.h>

#include <utility>

namespace limpid::scene {
namespace {

/// Subtrees from this depth on are counted by one thread.
constexpr uint32_t parallelDepth = 10;

/// Writes the number of leaves below each node.
void countLeaves(const BinaryTree& tree, uint32_t index, uint32_t depth, RawVector<uint32_t>& counts) {
    const BinaryNode& node = tree[index];
    counts[index] = 1;
    if (node.isLeaf()) return;
    const auto left = [&] { countLeaves(tree, node.child, depth + 1, counts); };
    const auto right = [&] { countLeaves(tree, node.child + 1, depth + 1, counts); };
    if (depth < parallelDepth) {
        tbb::parallel_invoke(left, right);
    } else {
        left();
        right();
    }
    counts[index] = counts[node.child] + counts[node.child + 1];
}

/// A copy of the tree below a node, in the order of a traversal. It ends at nodes where `ends` holds.
template <typename Ends>
BinaryTree copied(const BinaryTree& tree, uint32_t root, const Ends& ends) {
    BinaryTree copy{tree[root]};
    std::vector<std::pair<uint32_t, uint32_t>> open{{root, 0}};  // a node, and its copy
    while (!open.empty()) {
        const auto [from, to] = open.back();
        open.pop_back();
        if (ends(from, copy[to])) continue;
        const uint32_t child = tree[from].child;
        const auto children = static_cast<uint32_t>(copy.size());
        copy[to].child = children;
        copy.push_back(tree[child]);
        copy.push_back(tree[child + 1]);
        open.insert(open.end(), {{child + 1, children + 1}, {child, children}});
    }
    return copy;
}

}  // namespace

Cut cutTree(const BinaryTree& tree, uint32_t most) {
    RawVector<uint32_t> counts(tree.size());
    countLeaves(tree, 0, 0, counts);
    Cut cut;
    cut.top = copied(tree, 0, [&](uint32_t from, BinaryNode& copy) {
        if (counts[from] > most) return false;
        copy = {copy.bounds, 0, static_cast<uint32_t>(cut.roots.size())};
        cut.roots.push_back(from);
        return true;
    });
    return cut;
}

BinaryTree subtreeOf(const BinaryTree& tree, uint32_t root) {
    return copied(tree, root, [](uint32_t, const BinaryNode& copy) { return copy.isLeaf(); });
}

}  // namespace limpid::scene
