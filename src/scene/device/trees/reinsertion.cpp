#include "scene/device/trees/reinsertion.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>

#include "base/for_each_index.h"

namespace limpid::scene {
namespace {

/// Each round looks for better places of so many of the nodes: of those with the largest boxes.
constexpr uint32_t roundShare = 5;

/// To take a node from its place, and to put it beside another one.
struct Move {
    uint32_t node = 0, to = 0;
    float gain = 0.0f;  ///< by how much the sum of areas falls
};

Aabb united(Aabb a, const Aabb& b) {
    a.grow(b);
    return a;
}

class Reinserter {
  public:
    explicit Reinserter(BinaryTree& tree) : tree_(tree), parents_(tree.size()), touched_(tree.size()) {
        for (uint32_t i = 0; i < tree.size(); ++i) adopt(i);
    }

    /// One round; returns the number of moves.
    uint32_t round(uint32_t number) {
        const std::vector<uint32_t> candidates = largest();
        std::vector<Move> moves(candidates.size());
        const tbb::blocked_range<size_t> all(0, candidates.size(), 64);
        tbb::parallel_for(all, [&](const tbb::blocked_range<size_t>& range) {
            for (size_t i = range.begin(); i < range.end(); ++i) moves[i] = bestMove(candidates[i]);
        });
        std::erase_if(moves, [](const Move& move) { return move.gain <= 0.0f; });
        std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
            return a.gain != b.gain ? a.gain > b.gain : a.node < b.node;
        });
        return static_cast<uint32_t>(
            std::count_if(moves.begin(), moves.end(), [&](const Move& move) { return apply(move, number); }));
    }

  private:
    struct Place {
        float gain;  ///< before the node is put at or below this place
        uint32_t node;
    };

    void adopt(uint32_t node) {
        if (tree_[node].isLeaf()) return;
        parents_[tree_[node].child] = parents_[tree_[node].child + 1] = node;
    }

    std::vector<uint32_t> largest() const {
        // Numbers that are smaller the larger the box is, since the bits of positive floats grow with them.
        constexpr size_t firstMoved = 3;  // the root and its children stay
        RawVector<uint64_t> all(tree_.size() - firstMoved);
        forEachIndex(all.size(), [&](size_t i) {
            const size_t node = i + firstMoved;
            all[i] = uint64_t{~std::bit_cast<uint32_t>(tree_[node].bounds.halfArea())} << 32 | node;
        });
        const size_t count = std::min(all.size(), all.size() / roundShare + 64);
        std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end());
        std::vector<uint32_t> nodes(count);
        std::transform(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), nodes.begin(),
                       [](uint64_t candidate) { return static_cast<uint32_t>(candidate); });
        return nodes;
    }

    /// Looks below the siblings of the node and of its ancestors. `gain` is what leaving the old place saves
    /// below the ancestor that both places have in common.
    Move bestMove(uint32_t node) const {
        Move best{.node = node};
        uint32_t below = parents_[node];
        float gain = tree_[below].bounds.halfArea();
        search(siblingOf(node), gain, best);
        Aabb left = tree_[siblingOf(node)].bounds;  // what remains of `below` without the node
        while (below != 0) {
            search(siblingOf(below), gain, best);
            const uint32_t ancestor = parents_[below];
            left.grow(tree_[siblingOf(below)].bounds);
            gain += tree_[ancestor].bounds.halfArea() - left.halfArea();
            below = ancestor;
        }
        const bool stays = best.to == siblingOf(node) || best.to == parents_[node];
        return stays ? Move{} : best;
    }

    /// Branch and bound: a place costs at least the node's own area.
    void search(uint32_t root, float gain, Move& best) const {
        const Aabb& box = tree_[best.node].bounds;
        const float area = box.halfArea();
        thread_local std::vector<Place> stack;
        stack.assign(1, {gain, root});
        while (!stack.empty()) {
            const Place place = stack.back();
            stack.pop_back();
            if (place.gain - area <= best.gain) continue;
            const BinaryNode& there = tree_[place.node];
            const float here = place.gain - united(there.bounds, box).halfArea();
            if (here > best.gain) best = {best.node, place.node, here};
            if (there.isLeaf()) continue;
            const float below = here + there.bounds.halfArea();
            stack.push_back({below, there.child});
            stack.push_back({below, there.child + 1});
        }
    }

    /// Does nothing where an earlier move of this round has touched the same nodes.
    bool apply(const Move& move, uint32_t round) {
        const uint32_t sibling = siblingOf(move.node), parent = parents_[move.node];
        const std::array<uint32_t, 5> nodes{move.node, sibling, parent, move.to, parents_[move.to]};
        if (std::any_of(nodes.begin(), nodes.end(), [&](uint32_t i) { return touched_[i] == round; }))
            return false;
        // Or where one has brought the new place below the node.
        for (uint32_t i = move.to; i != 0; i = parents_[i]) {
            if (i == move.node) return false;
        }
        for (const uint32_t i : nodes) touched_[i] = round;
        // The sibling takes its parent's place. The pair of both becomes the node's and that of what was at
        // `to`.
        const BinaryNode there = tree_[move.to];
        tree_[parent] = tree_[sibling];
        adopt(parent);
        tree_[sibling] = there;
        adopt(sibling);
        tree_[move.to].primitive = BinaryNode::inner;
        tree_[move.to].child = std::min(move.node, sibling);
        adopt(move.to);
        refit(move.to);
        refit(parents_[parent]);
        return true;
    }

    void refit(uint32_t node) {
        for (;; node = parents_[node]) {
            const uint32_t child = tree_[node].child;
            tree_[node].bounds = united(tree_[child].bounds, tree_[child + 1].bounds);
            if (node == 0) return;
        }
    }

    BinaryTree& tree_;
    std::vector<uint32_t> parents_;
    std::vector<uint8_t> touched_;  ///< the round of the last move that has changed a node
};

}  // namespace

void reinsert(BinaryTree& tree, uint32_t rounds, const Progress& progress) {
    if (rounds == 0 || tree.size() < 5) return;
    Reinserter reinserter(tree);
    for (uint32_t round = 1; round <= rounds; ++round) {
        if (reinserter.round(round) == 0) return;
        progress.at(round, rounds);
    }
}

}  // namespace limpid::scene
