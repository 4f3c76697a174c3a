#include "scene/device/trees/collapse.h"

#include <algorithm>

namespace limpid::scene {
namespace {

/// The cost of visiting a wide node, in tests of a triangle.
constexpr float nodeCost = 1.7f;

}  // namespace

Collapse::Collapse(const BinaryTree& tree, uint32_t maxLeafSize)
    : tree_(tree), maxLeafSize_(maxLeafSize), best_(tree.size()) {
    solve(0);
}

std::vector<uint32_t> Collapse::childrenOf(uint32_t node) const {
    std::vector<uint32_t> children;
    if (becomesLeaf(node))
        children.push_back(node);
    else
        share(node, width, children);
    return children;
}

void Collapse::solve(uint32_t index) {
    const BinaryNode& node = tree_[index];
    const float area = node.bounds.halfArea();
    Best& best = best_[index] = {};
    if (node.isLeaf()) {
        best.costs.fill(area);
        best.count = best.leaf = 1;
        return;
    }
    solve(node.child);
    solve(node.child + 1);
    best.count = best_[node.child].count + best_[node.child + 1].count;
    const float asNode = nodeCost * area + shared(node, width, bestShare(node, width));
    const float asLeaf = area * static_cast<float>(best.count);
    best.leaf = best.count <= maxLeafSize_ && asLeaf <= asNode;
    best.costs[0] = best.leaf ? asLeaf : asNode;
    for (uint32_t slots = 2; slots < width; ++slots) {
        const float apart = shared(node, slots, bestShare(node, slots));
        best.costs[slots - 1] = std::min(apart, best.costs[slots - 2]);
    }
}

/// The cost if `left` of the children go to the first child's subtree.
float Collapse::shared(const BinaryNode& node, uint32_t slots, uint32_t left) const {
    return best_[node.child].costs[left - 1] + best_[node.child + 1].costs[slots - left - 1];
}

uint32_t Collapse::bestShare(const BinaryNode& node, uint32_t slots) const {
    uint32_t best = 1;
    for (uint32_t left = 2; left < slots; ++left) {
        if (shared(node, slots, left) < shared(node, slots, best)) best = left;
    }
    return best;
}

void Collapse::collect(uint32_t node, uint32_t slots, std::vector<uint32_t>& children) const {
    const Best& best = best_[node];
    while (slots > 1 && best.costs[slots - 1] == best.costs[slots - 2]) --slots;
    if (slots == 1)
        children.push_back(node);
    else
        share(node, slots, children);
}

void Collapse::share(uint32_t node, uint32_t slots, std::vector<uint32_t>& children) const {
    const uint32_t left = bestShare(tree_[node], slots);
    collect(tree_[node].child, left, children);
    collect(tree_[node].child + 1, slots - left, children);
}

}  // namespace limpid::scene
