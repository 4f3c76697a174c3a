#include "scene/device/trees/bvh.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <numeric>

#include "base/error.h"

namespace limpid::scene {
namespace {

constexpr uint32_t binCount = 16;
constexpr uint32_t parallelThreshold = 4096;
/// Costs in the surface area heuristic: visiting a binary node, and testing a triangle.
constexpr float traversalCost = 0.7f;
constexpr float intersectionCost = 1.0f;

struct BinaryNode {
    Aabb bounds;
    uint32_t first = 0;
    uint32_t count = 0;  ///< 0: an inner node
    std::array<uint32_t, 2> children{};
};

struct Bin {
    Aabb bounds;
    uint32_t count = 0;
};

struct Split {
    int axis = -1;
    uint32_t bin = 0;  ///< primitives of this bin and lower ones go left
    float cost = std::numeric_limits<float>::max();
};

class BinaryBuilder {
  public:
    BinaryBuilder(std::span<const Aabb> boxes, uint32_t maxLeafSize, uint32_t sahDepth,
                  const Progress& progress)
        : boxes_(boxes), maxLeafSize_(maxLeafSize), sahDepth_(sahDepth), progress_(progress) {
        order_.resize(boxes.size());
        std::iota(order_.begin(), order_.end(), 0u);
        nodes_.resize(2 * boxes.size());
        build(allocate(1), 0, static_cast<uint32_t>(boxes.size()), 0);
    }

    const BinaryNode& node(uint32_t index) const { return nodes_[index]; }
    std::vector<uint32_t> takeOrder() { return std::move(order_); }

  private:
    uint32_t allocate(uint32_t count) { return used_.fetch_add(count, std::memory_order_relaxed); }
    vec3 center(uint32_t slot) const { return boxes_[order_[slot]].center(); }

    void build(uint32_t index, uint32_t first, uint32_t count, uint32_t depth) {
        BinaryNode& node = nodes_[index];
        Aabb centers;
        for (uint32_t i = first; i < first + count; ++i) {
            node.bounds.grow(boxes_[order_[i]]);
            centers.grow(center(i));
        }
        const uint32_t leftCount = count <= 1 ? 0 : partition(node.bounds, centers, first, count, depth);
        if (leftCount == 0) {
            node.first = first;
            node.count = count;
            return;
        }
        const uint32_t children = allocate(2);
        node.children = {children, children + 1};
        const auto left = [&] { build(children, first, leftCount, depth + 1); };
        const auto right = [&] { build(children + 1, first + leftCount, count - leftCount, depth + 1); };
        if (count > parallelThreshold) {
            tbb::parallel_invoke(left, right);
            if (leftCount <= parallelThreshold) report(leftCount);
            if (count - leftCount <= parallelThreshold) report(count - leftCount);
        } else {
            left();
            right();
        }
    }

    /// Reports that a small subtree of so many primitives is done.
    void report(uint32_t count) {
        const uint32_t placed = placed_.fetch_add(count, std::memory_order_relaxed) + count;
        progress_.at(placed, boxes_.size());
    }

    /// Partitions the range and returns the left part's size; 0 makes a leaf.
    uint32_t partition(const Aabb& bounds, const Aabb& centers, uint32_t first, uint32_t count,
                       uint32_t depth) {
        const Split split = depth < sahDepth_ ? findSplit(centers, first, count) : Split{};
        const float area = bounds.halfArea();
        const float leafCost = intersectionCost * static_cast<float>(count);
        const bool worthIt =
            split.axis >= 0 && traversalCost + split.cost / std::max(area, 1e-30f) < leafCost;
        if (count <= maxLeafSize_ && !worthIt) return 0;
        const auto begin = order_.begin() + first;
        if (split.axis >= 0) {
            const float low = centers.lower[split.axis];
            const float scale = binScale(centers, split.axis);
            const auto middle = std::partition(begin, begin + count, [&](uint32_t primitive) {
                return binOf(boxes_[primitive].center()[split.axis], low, scale) <= split.bin;
            });
            return static_cast<uint32_t>(middle - begin);
        }
        const vec3 size = centers.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        std::nth_element(begin, begin + count / 2, begin + count, [&](uint32_t a, uint32_t b) {
            const float ca = boxes_[a].center()[axis], cb = boxes_[b].center()[axis];
            return ca != cb ? ca < cb : a < b;
        });
        return count / 2;
    }

    static float binScale(const Aabb& centers, int axis) {
        return static_cast<float>(binCount) * 0.9999f / (centers.upper[axis] - centers.lower[axis]);
    }
    static uint32_t binOf(float center, float low, float scale) {
        return std::min(static_cast<uint32_t>((center - low) * scale), binCount - 1);
    }

    using Bins = std::array<Bin, binCount>;

    Bins fillBins(int axis, float low, float scale, uint32_t first, uint32_t count) const {
        const auto fill = [&](const tbb::blocked_range<uint32_t>& range, Bins bins) {
            for (uint32_t i = range.begin(); i < range.end(); ++i) {
                const Aabb& box = boxes_[order_[i]];
                Bin& bin = bins[binOf(box.center()[axis], low, scale)];
                bin.bounds.grow(box);
                ++bin.count;
            }
            return bins;
        };
        const tbb::blocked_range<uint32_t> all(first, first + count, 1u << 16);
        if (count <= 1u << 17) return fill(all, Bins{});
        return tbb::parallel_reduce(all, Bins{}, fill, [](Bins a, const Bins& b) {
            for (uint32_t i = 0; i < binCount; ++i) {
                a[i].bounds.grow(b[i].bounds);
                a[i].count += b[i].count;
            }
            return a;
        });
    }

    Split findSplit(const Aabb& centers, uint32_t first, uint32_t count) const {
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            const float low = centers.lower[axis];
            const float scale = binScale(centers, axis);
            if (!(centers.upper[axis] > low) || !std::isfinite(scale)) continue;
            const Bins bins = fillBins(axis, low, scale, first, count);
            std::array<float, binCount> rightCost{};
            Bin right;
            for (uint32_t i = binCount - 1; i > 0; --i) {
                right.bounds.grow(bins[i].bounds);
                right.count += bins[i].count;
                rightCost[i] = right.bounds.halfArea() * static_cast<float>(right.count);
            }
            Bin left;
            for (uint32_t i = 0; i + 1 < binCount; ++i) {
                left.bounds.grow(bins[i].bounds);
                left.count += bins[i].count;
                if (left.count == 0 || left.count == count) continue;
                const float cost = left.bounds.halfArea() * static_cast<float>(left.count) + rightCost[i + 1];
                if (cost < best.cost) best = {axis, i, cost};
            }
        }
        best.cost *= intersectionCost;
        return best;
    }

    std::span<const Aabb> boxes_;
    uint32_t maxLeafSize_;
    uint32_t sahDepth_;
    std::vector<uint32_t> order_;
    std::vector<BinaryNode> nodes_;
    std::atomic<uint32_t> used_{0};
    Progress progress_;
    std::atomic<uint32_t> placed_{0};
};

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

/// Collapses the binary tree: a node replaces its largest child by that child's children until it has four.
class WideBuilder {
  public:
    WideBuilder(const BinaryBuilder& binary, Bvh& out) : binary_(binary), out_(out) {}

    /// Writes the node for `children` and returns how many stack entries its subtree needs.
    uint32_t emit(uint32_t index, std::vector<uint32_t> children) {
        open(children);
        std::vector<BvhChild> wide;
        uint32_t deepest = 0;
        for (const uint32_t childIndex : children) {
            const BinaryNode& child = binary_.node(childIndex);
            if (child.count > 0) {
                wide.push_back({BvhRef::leaf(child.first, child.count), child.bounds});
                continue;
            }
            const auto wideIndex = static_cast<uint32_t>(out_.nodes.size());
            wide.push_back({BvhRef::node(wideIndex), child.bounds});
            out_.nodes.emplace_back();
            deepest = std::max(deepest, emit(wideIndex, {child.children[0], child.children[1]}));
        }
        out_.nodes[index] = makeBvhNode(wide);
        return deepest + 3;
    }

  private:
    void open(std::vector<uint32_t>& children) const {
        while (children.size() < 4) {
            size_t largest = children.size();
            float area = -1.0f;
            for (size_t i = 0; i < children.size(); ++i) {
                const BinaryNode& child = binary_.node(children[i]);
                if (child.count == 0 && child.bounds.halfArea() > area) {
                    area = child.bounds.halfArea();
                    largest = i;
                }
            }
            if (largest == children.size()) return;
            const BinaryNode& opened = binary_.node(children[largest]);
            children[largest] = opened.children[0];
            children.push_back(opened.children[1]);
        }
    }

    const BinaryBuilder& binary_;
    Bvh& out_;
};

}  // namespace

float Aabb::halfArea() const {
    if (empty()) return 0.0f;
    const vec3 s = size();
    return s.x * s.y + s.y * s.z + s.z * s.x;
}

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

Bvh buildBvh(std::span<const Aabb> boxes, uint32_t maxLeafSize, uint32_t sahDepth, const Progress& progress) {
    if (boxes.size() > BvhRef::maxIndex) {
        throw Error(
            fmt::format("{} primitives in one tree exceed the limit of {}", boxes.size(), BvhRef::maxIndex));
    }
    Bvh bvh;
    bvh.nodes.emplace_back();
    if (boxes.empty()) {
        // Leaves beyond the end of the triangles: reads there return zeros, which no ray hits.
        for (int axis = 0; axis < 3; ++axis) bvh.nodes[0].lower[axis].fill(255);
        bvh.nodes[0].exponents.fill(127);
        bvh.nodes[0].children.fill(BvhRef::leaf(0, 1));
        bvh.stackSize = 3;
        return bvh;
    }
    BinaryBuilder binary(boxes, maxLeafSize, sahDepth, progress);
    bvh.bounds = binary.node(0).bounds;
    bvh.nodes.reserve(boxes.size() / 2 + 1);
    const BinaryNode& root = binary.node(0);
    WideBuilder wide(binary, bvh);
    bvh.stackSize = root.count > 0 ? wide.emit(0, {0}) : wide.emit(0, {root.children[0], root.children[1]});
    bvh.order = binary.takeOrder();
    return bvh;
}

}  // namespace limpid::scene
