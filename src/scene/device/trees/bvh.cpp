#include "scene/device/trees/bvh.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/for_each_index.h"
#include "scene/device/run_both.h"
#include "scene/device/trees/collapse.h"
#include "scene/device/trees/cut.h"
#include "scene/device/trees/reinsertion.h"

namespace limpid::scene {
namespace {

float cellSize(uint8_t exponent) {
    return std::bit_cast<float>(static_cast<uint32_t>(exponent) << 23);
}

/// Returns the smallest power of two (as a biased exponent) of which 255 cells reach from `low` to `high`.
uint8_t gridExponent(float low, float high) {
    const float size = high - low;
    int exponent = 1;
    if (size > 0.0f) exponent = std::clamp(std::ilogb(size / 255.0f) + 127, 1, 254);
    while (exponent < 254 && low + 255.0f * cellSize(static_cast<uint8_t>(exponent)) < high) ++exponent;
    return static_cast<uint8_t>(exponent);
}

void quantise(BvhNode& node, uint32_t child, const Aabb& box) {
    for (int axis = 0; axis < 3; ++axis) {
        const float cell = cellSize(node.exponents[axis]);
        const float origin = node.origin[axis];
        int low = std::clamp(static_cast<int>(std::floor((box.lower[axis] - origin) / cell)), 0, 255);
        int high = std::clamp(static_cast<int>(std::ceil((box.upper[axis] - origin) / cell)), 0, 255);
        // The division rounds, but the box that the shader decodes must enclose the original.
        while (low > 0 && origin + static_cast<float>(low) * cell > box.lower[axis]) --low;
        while (high < 255 && origin + static_cast<float>(high) * cell < box.upper[axis]) ++high;
        node.lower[axis][child] = static_cast<uint8_t>(low);
        node.upper[axis][child] = static_cast<uint8_t>(high);
    }
}

/// Writes the wide nodes of a collapsed tree, and the order of primitives in their leaves.
class WideBuilder {
  public:
    /// With `parts`, leaves of the binary tree are parts: trees that were made before, by index.
    WideBuilder(const Collapse& collapse, Bvh& out, std::span<Bvh> parts = {})
        : collapse_(collapse), out_(out), parts_(parts), places_(parts.size()) {}

    /// Appends the nodes of the subtree of `binary`, and returns how many stack entries it needs.
    uint32_t emit(uint32_t binary) {
        const size_t index = out_.nodes.size();
        out_.nodes.emplace_back(BvhNode{});
        std::vector<BvhChild> wide;
        uint32_t deepest = 0;
        for (const uint32_t child : collapse_.childrenOf(binary)) {
            const BinaryNode& node = collapse_.tree()[child];
            if (parts_.empty() && collapse_.becomesLeaf(child)) {
                wide.push_back({leaf(child), node.bounds});
                continue;
            }
            const bool isPart = !parts_.empty() && node.isLeaf();
            if (isPart && isOneLeaf(parts_[node.primitive])) {
                wide.push_back({leafOfPart(node.primitive), node.bounds});
                continue;
            }
            wide.push_back({BvhRef::node(static_cast<uint32_t>(out_.nodes.size())), node.bounds});
            deepest = std::max(deepest, isPart ? reservePart(node.primitive) : emit(child));
        }
        out_.nodes[index] = makeBvhNode(wide);
        return deepest + 3;
    }

    /// Copies the parts to their places, and frees them.
    void fillParts() {
        tbb::parallel_for(size_t{0}, places_.size(), [&](size_t i) {
            const Bvh part = std::exchange(parts_[i], {});
            const Place& place = places_[i];
            auto out = out_.nodes.begin() + place.node;
            for (BvhNode node : isOneLeaf(part) ? std::span<const BvhNode>() : part.nodes) {
                for (uint32_t& child : node.children)
                    child += BvhRef::isLeaf(child) ? place.entry : place.node;
                *out++ = node;
            }
            std::copy(part.order.begin(), part.order.end(), out_.order.begin() + place.entry);
        });
    }

  private:
    /// Where a part begins.
    struct Place {
        uint32_t node, entry;
    };

    uint32_t reservePart(uint32_t index) {
        const Bvh& part = parts_[index];
        places_[index] = {static_cast<uint32_t>(out_.nodes.size()), static_cast<uint32_t>(out_.order.size())};
        out_.nodes.resize(out_.nodes.size() + part.nodes.size());
        out_.order.resize(out_.order.size() + part.order.size());
        return part.stackSize;
    }

    /// Such a part needs no node.
    static bool isOneLeaf(const Bvh& part) {
        const BvhNode& root = part.nodes.front();
        return !root.hasChild(1) && BvhRef::isLeaf(root.children[0]);
    }

    uint32_t leafOfPart(uint32_t index) {
        const Bvh& part = parts_[index];
        places_[index] = {0, static_cast<uint32_t>(out_.order.size())};
        out_.order.resize(out_.order.size() + part.order.size());
        return part.nodes.front().children[0] + places_[index].entry;
    }

    uint32_t leaf(uint32_t binary) {
        const auto first = static_cast<uint32_t>(out_.order.size());
        place(binary, first);
        return BvhRef::leaf(first, static_cast<uint32_t>(out_.order.size()) - first);
    }

    void place(uint32_t binary, uint32_t first) {
        const BinaryNode& node = collapse_.tree()[binary];
        if (!node.isLeaf()) {
            place(node.child, first);
            place(node.child + 1, first);
            return;
        }
        // Parts of one triangle count once.
        if (std::find(out_.order.begin() + first, out_.order.end(), node.primitive) == out_.order.end())
            out_.order.push_back(node.primitive);
    }

    const Collapse& collapse_;
    Bvh& out_;
    std::span<Bvh> parts_;
    std::vector<Place> places_;
};

}  // namespace

Aabb BvhNode::childBounds(uint32_t child) const {
    Aabb box;
    for (int axis = 0; axis < 3; ++axis) {
        const float cell = cellSize(exponents[axis]);
        box.lower[axis] = origin[axis] + static_cast<float>(lower[axis][child]) * cell;
        box.upper[axis] = origin[axis] + static_cast<float>(upper[axis][child]) * cell;
    }
    return box;
}

BvhNode makeBvhNode(std::span<const BvhChild> children) {
    Aabb bounds;
    for (const BvhChild& child : children) bounds.grow(child.bounds);
    BvhNode node;
    node.origin = bounds.lower;
    for (int axis = 0; axis < 3; ++axis) {
        node.exponents[axis] = gridExponent(bounds.lower[axis], bounds.upper[axis]);
        node.lower[axis].fill(255);
    }
    for (uint32_t slot = 0; slot < children.size(); ++slot) {
        quantise(node, slot, children[slot].bounds);
        node.children[slot] = children[slot].ref;
    }
    // Far away, rounding can make a missing child's inverted box valid, so its reference must be harmless.
    for (size_t slot = children.size(); slot < 4; ++slot) node.children[slot] = node.children[0];
    return node;
}

namespace {

/// Larger leaves cost more tests but fewer nodes (measured in docs/benchmarks.md).
constexpr uint32_t maxTrianglesPerLeaf = 4;
/// Trees of more triangles are built in parts, which takes less time and memory.
constexpr size_t hugeTree = size_t{1} << 23;

/// Of reinsertion.
uint32_t roundsFor(size_t triangles) {
    return triangles > maxSplitTriangles ? 1 : 5;
}

void checkCount(size_t primitives) {
    if (primitives <= BvhRef::maxIndex) return;
    throw Error(
        fmt::format("{} primitives in one tree exceed the limit of {}", primitives, BvhRef::maxIndex));
}

/// Leaves beyond the end of the triangles: reads there return zeros, which no ray hits.
Bvh emptyBvh() {
    Bvh bvh;
    BvhNode& node = bvh.nodes.emplace_back(BvhNode{});
    for (int axis = 0; axis < 3; ++axis) node.lower[axis].fill(255);
    node.exponents.fill(127);
    node.children.fill(BvhRef::leaf(0, 1));
    bvh.stackSize = 3;
    return bvh;
}

/// Written by one thread.
Bvh smallBvh(const BinaryTree& tree, uint32_t maxLeafSize) {
    const Collapse collapse(tree, maxLeafSize);
    Bvh bvh;
    bvh.bounds = tree[0].bounds;
    bvh.stackSize = WideBuilder(collapse, bvh).emit(0);
    bvh.nodes.shrink_to_fit();
    bvh.order.shrink_to_fit();
    return bvh;
}

/// The leaves of `top` are the parts, which this frees.
Bvh joined(const BinaryTree& top, std::vector<Bvh> parts) {
    if (parts.size() == 1) return std::move(parts.front());
    const Collapse collapse(top, 1);
    Bvh bvh;
    bvh.bounds = top[0].bounds;
    size_t nodes = parts.size(), entries = 0;  // there are fewer above the parts
    for (const Bvh& part : parts) {
        nodes += part.nodes.size();
        entries += part.order.size();
    }
    bvh.nodes.reserve(nodes);
    bvh.order.reserve(entries);
    WideBuilder builder(collapse, bvh, parts);
    bvh.stackSize = builder.emit(0);
    builder.fillParts();
    return bvh;
}

/// Subtrees of up to so many leaves are one thread's work.
constexpr uint32_t leavesOfAPart = 1u << 15;

Bvh wideBvh(const BinaryTree& tree, uint32_t maxLeafSize) {
    if (tree.size() < 2 * leavesOfAPart) return smallBvh(tree, maxLeafSize);
    const Cut cut = cutTree(tree, leavesOfAPart);
    std::vector<Bvh> parts(cut.roots.size());
    tbb::parallel_for(size_t{0}, parts.size(),
                      [&](size_t i) { parts[i] = smallBvh(subtreeOf(tree, cut.roots[i]), maxLeafSize); });
    return joined(cut.top, std::move(parts));
}

/// With room for more.
References referencesTo(std::span<const Corners> triangles, size_t room = 0) {
    References references;
    references.reserve(triangles.size() + room);
    references.resize(triangles.size());
    forEachIndex(triangles.size(), [&](size_t i) {
        references[i] = {boxOf(triangles[i]), static_cast<uint32_t>(i)};
    });
    return references;
}

/// Share of the time to build a tree in parts that the upper nodes take (measured).
constexpr double shareOfTop = 0.4;

Bvh movedBvh(References triangles, const Splits& splits, const Progress& progress) {
    const size_t count = triangles.size();
    checkCount(count + splits.most);
    if (triangles.empty()) return emptyBvh();
    BinaryTree tree = buildBinaryTree(std::move(triangles), maxSahDepth, splits, progress.part(0.0, 0.6));
    reinsert(tree, roundsFor(count), progress.part(0.6, 1.0));
    return wideBvh(tree, maxTrianglesPerLeaf);
}

}  // namespace

Bvh buildBvh(std::span<const Aabb> boxes, uint32_t maxLeafSize, uint32_t sahDepth) {
    checkCount(boxes.size());
    if (boxes.empty()) return emptyBvh();
    References references(boxes.size());
    for (uint32_t i = 0; i < boxes.size(); ++i) references[i] = {boxes[i], i};
    return wideBvh(buildBinaryTree(std::move(references), sahDepth), maxLeafSize);
}

Bvh buildBvhInParts(References references, uint32_t maxLeafSize, uint32_t partSize,
                    const Progress& progress) {
    checkCount(references.size());
    if (references.empty()) return emptyBvh();
    TreeTop top = buildTreeTop(std::move(references), maxSahDepth, partSize, progress.part(0.0, shareOfTop));
    std::vector<Bvh> parts(top.parts.size());
    std::atomic<size_t> done = 0;
    const Progress rest = progress.part(shareOfTop, 1.0);
    runAll(parts.size(), [&](size_t i) {
        rest.at(done, parts.size());  // does not begin if all is given up
        const TreeTop::Part& part = top.parts[i];
        const auto first = top.references.begin() + part.first;
        const BinaryTree tree =
            buildBinaryTree({first, first + part.count}, maxSahDepth - std::min(part.depth, maxSahDepth));
        parts[i] = smallBvh(tree, maxLeafSize);
        rest.at(++done, parts.size());
    });
    top.references = References();  // frees them, which {} would not
    return joined(top.nodes, std::move(parts));
}

Bvh buildTriangleBvh(References triangles, const Progress& progress) {
    if (triangles.size() > hugeTree)
        return buildBvhInParts(std::move(triangles), maxTrianglesPerLeaf, leavesOfAPart, progress);
    return movedBvh(std::move(triangles), {}, progress);
}

Bvh buildTriangleBvh(std::span<const Corners> triangles, const std::vector<bool>& divisible,
                     const Progress& progress) {
    if (triangles.size() > maxSplitTriangles) return buildTriangleBvh(referencesTo(triangles), progress);
    const auto most = static_cast<size_t>(std::count(divisible.begin(), divisible.end(), true));
    References references = referencesTo(triangles, most);
    return movedBvh(std::move(references), {triangles, divisible, static_cast<uint32_t>(most)}, progress);
}

}  // namespace limpid::scene
