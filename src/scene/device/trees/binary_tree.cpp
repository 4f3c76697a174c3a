#include "scene/device/trees/binary_tree.h"

#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "scene/device/run_both.h"
#include "scene/device/trees/box4.h"
#include "scene/device/trees/cut.h"
#include "scene/device/trees/parallel_partition.h"

namespace limpid::scene {
namespace {

constexpr uint32_t binCount = 16;
constexpr uint32_t parallelThreshold = 4096;
/// Splits of triangles are tried where the children overlap by more than this share of the root's area,
constexpr float leastOverlap = 1e-3f;
/// and used where they cost less than this share of the best split without them.
constexpr float mostOfCost = 0.9f;

struct Bin {
    Box4 bounds;
    uint32_t first = 0;  ///< number of references that begin in this bin
    uint32_t last = 0;   ///< and that end here
};

using Bins = std::array<Bin, binCount>;

/// Equal intervals of an axis.
struct Axis {
    int axis;
    float low, scale;

    Axis(int number, float from, float to)
        : axis(number), low(from), scale(static_cast<float>(binCount) * 0.9999f / (to - from)) {}

    bool usable(float to) const { return to > low && std::isfinite(scale); }
    uint32_t binOf(float at) const {
        return std::min(static_cast<uint32_t>(std::max((at - low) * scale, 0.0f)), binCount - 1);
    }
    /// Where a bin begins.
    float planeBefore(uint32_t bin) const { return low + static_cast<float>(bin) / scale; }
};

struct Split {
    int axis = -1;
    uint32_t bin = 0;  ///< what ends in this bin or lower ones goes left
    float cost = std::numeric_limits<float>::max();
    uint32_t left = 0, right = 0;  ///< number of references
    Box4 leftBounds, rightBounds;
};

/// Keeps the best split between two of the bins.
void chooseSplit(const Bins& bins, int axis, Split& best) {
    std::array<Bin, binCount> after;  // all bins from this one on
    Bin right;
    for (uint32_t i = binCount - 1; i > 0; --i) {
        right.bounds.grow(bins[i].bounds);
        right.last += bins[i].last;
        after[i] = right;
    }
    Bin left;
    for (uint32_t i = 0; i + 1 < binCount; ++i) {
        left.bounds.grow(bins[i].bounds);
        left.first += bins[i].first;
        const Bin& other = after[i + 1];
        if (left.first == 0 || other.last == 0) continue;
        const float cost = left.bounds.halfArea() * static_cast<float>(left.first) +
                           other.bounds.halfArea() * static_cast<float>(other.last);
        if (cost < best.cost) best = {axis, i, cost, left.first, other.last, left.bounds, other.bounds};
    }
}

/// The bins of references, which `add` adds one by one. Threads take so many each.
template <typename Add>
Bins fillBins(std::span<const Reference> references, size_t grain, const Add& add) {
    const auto fill = [&](const tbb::blocked_range<size_t>& range, Bins bins) {
        for (size_t i = range.begin(); i < range.end(); ++i) add(references[i], bins);
        return bins;
    };
    const tbb::blocked_range<size_t> all(0, references.size(), grain);
    if (references.size() <= 2 * grain) return fill(all, Bins{});
    return tbb::parallel_reduce(all, Bins{}, fill, [](Bins a, const Bins& b) {
        for (uint32_t i = 0; i < binCount; ++i) {
            a[i].bounds.grow(b[i].bounds);
            a[i].first += b[i].first;
            a[i].last += b[i].last;
        }
        return a;
    });
}

struct Boxes {
    Box4 all, centers;
};

/// The box of all references, and that of their centers.
Boxes boxesOf(std::span<const Reference> references) {
    const auto add = [&](const tbb::blocked_range<size_t>& range, Boxes boxes) {
        for (size_t i = range.begin(); i < range.end(); ++i) {
            const Box4 box = Box4::of(references[i].bounds);
            boxes.all.grow(box);
            boxes.centers.grow(box.center(), box.center());
        }
        return boxes;
    };
    constexpr size_t grain = size_t{1} << 16;
    const tbb::blocked_range<size_t> all(0, references.size(), grain);
    if (references.size() <= 2 * grain) return add(all, Boxes{});
    return tbb::parallel_reduce(all, Boxes{}, add, [](Boxes a, const Boxes& b) {
        a.all.grow(b.all);
        a.centers.grow(b.centers);
        return a;
    });
}

class Builder {
  public:
    /// Nodes of up to `partSize` references become leaves: parts, if it is more than 1.
    Builder(References references, uint32_t sahDepth, const Splits& splits, uint32_t partSize,
            const Progress& progress)
        : references_(std::move(references)),
          splits_(splits),
          sahDepth_(sahDepth),
          partSize_(partSize),
          progress_(progress) {
        const auto count = static_cast<uint32_t>(references_.size());
        references_.resize(count + splits.most);
        nodes_.resize(2 * references_.size() - 1);  // memory that is not written is not used
        build(0, 1, {0, count, splits.most}, 0);
        if (splits.most > 0 || partSize > 1) nodes_ = subtreeOf(nodes_, 0);
    }

    BinaryTree take() { return std::move(nodes_); }
    TreeTop takeTop() {
        TreeTop top{std::move(nodes_), {}, std::move(references_)};
        std::vector<std::pair<uint32_t, uint32_t>> open{{0, 0}};
        while (!open.empty()) {
            const auto [index, depth] = open.back();
            open.pop_back();
            BinaryNode& node = top.nodes[index];
            if (node.isLeaf()) {
                const TreeTop::Part part{node.primitive, node.child, depth};
                node.primitive = static_cast<uint32_t>(top.parts.size());
                top.parts.push_back(part);
            } else {
                open.insert(open.end(), {{node.child + 1, depth + 1}, {node.child, depth + 1}});
            }
        }
        return top;
    }

  private:
    /// References, and room for more behind them.
    struct Range {
        uint32_t first, count, room;
    };

    std::span<Reference> in(const Range& range) { return {references_.data() + range.first, range.count}; }
    std::span<const Reference> in(const Range& range) const {
        return {references_.data() + range.first, range.count};
    }

    /// Nodes below this one are numbered from `children` on, with gaps where room for references was not
    /// used. So their numbers do not depend on the threads. Where leaves are parts, gaps would be as large as
    /// the parts: nodes are numbered as they come, until they are put in order.
    void build(uint32_t index, uint32_t children, const Range& range, uint32_t depth) {
        BinaryNode& node = nodes_[index] = {};
        if (range.count <= partSize_) return makeLeaf(node, range);
        if (partSize_ > 1) children = used_.fetch_add(2, std::memory_order_relaxed);
        if (range.count > parallelThreshold) progress_.at(0.0);  // ends here if it is given up
        const Boxes boxes = boxesOf(in(range));
        node.bounds = boxes.all.aabb();
        if (index == 0) leastOverlap_ = leastOverlap * node.bounds.halfArea();
        const Halves halves = partition(boxes, range, depth);
        const Range &left = halves.left, &right = halves.right;
        node.child = children;
        const uint32_t afterLeft = children + 2 * (left.count + left.room);
        const auto buildLeft = [&] { build(children, children + 2, left, depth + 1); };
        const auto buildRight = [&] { build(children + 1, afterLeft, right, depth + 1); };
        if (range.count > parallelThreshold) {
            const uint32_t reported = std::max(partSize_, parallelThreshold);
            runBoth(buildLeft, buildRight);
            if (left.count <= reported) report(left.count);
            if (right.count <= reported) report(right.count);
        } else {
            buildLeft();
            buildRight();
        }
    }

    /// A leaf that is a part holds its range of references until takeTop(): the first in `primitive`, their
    /// number in `child`.
    void makeLeaf(BinaryNode& node, const Range& range) const {
        if (partSize_ > 1) {
            node.bounds = boxesOf(in(range)).all.aabb();
            node.primitive = range.first;
            node.child = range.count;
        } else {
            node.bounds = references_[range.first].bounds;
            node.primitive = references_[range.first].primitive;
        }
    }

    /// Reports that a small subtree of so many references is done.
    void report(uint32_t count) {
        const uint32_t placed = placed_.fetch_add(count, std::memory_order_relaxed) + count;
        progress_.at(std::min<size_t>(placed, references_.size()), references_.size());
    }

    struct Halves {
        Range left, right;
    };

    Halves partition(const Boxes& boxes, const Range& range, uint32_t depth) {
        if (range.count == 2 && range.room == 0) return divided(range, 1);
        const Aabb centers = boxes.centers.aabb();
        const Split split = depth < sahDepth_ ? objectSplit(centers, range) : Split{};
        if (split.axis < 0) return halved(centers, range);
        if (range.room > 0) {
            const Split spatial = spatialSplit(boxes.all.aabb(), split, range);
            if (spatial.cost < mostOfCost * split.cost) return splitAt(spatial, boxes.all.aabb(), range);
        }
        const Axis axis(split.axis, centers.lower[split.axis], centers.upper[split.axis]);
        const size_t left = partitionInParallel(in(range), [&](const Reference& reference) {
            return axis.binOf(reference.bounds.center()[split.axis]) <= split.bin;
        });
        return divided(range, static_cast<uint32_t>(left));
    }

    Halves halved(const Aabb& centers, const Range& range) {
        const vec3 size = centers.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::span<Reference> all = in(range);
        std::nth_element(all.begin(), all.begin() + range.count / 2, all.end(),
                         [&](const Reference& a, const Reference& b) {
                             const float ca = a.bounds.center()[axis], cb = b.bounds.center()[axis];
                             return ca != cb ? ca < cb : a.primitive < b.primitive;
                         });
        return divided(range, range.count / 2);
    }

    /// The first `left` references, and the others. Room is shared in proportion; that of the left half comes
    /// between.
    Halves divided(const Range& range, uint32_t left) {
        const uint32_t right = range.count - left;
        const auto room = static_cast<uint32_t>(uint64_t{range.room} * left / range.count);
        const auto from = references_.begin() + range.first + left;
        std::move_backward(from, from + right, from + right + room);
        return {{range.first, left, room}, {range.first + left + room, right, range.room - room}};
    }

    /// Without an axis where all centers are the same.
    Split objectSplit(const Aabb& centers, const Range& range) const {
        Split best;
        for (int number = 0; number < 3; ++number) {
            const Axis axis(number, centers.lower[number], centers.upper[number]);
            if (!axis.usable(centers.upper[number])) continue;
            const auto add = [&](const Reference& reference, Bins& bins) {
                Bin& bin = bins[axis.binOf(reference.bounds.center()[number])];
                bin.bounds.grow(Box4::of(reference.bounds));
                ++bin.first;
                ++bin.last;
            };
            chooseSplit(fillBins(in(range), 1u << 16, add), number, best);
        }
        return best;
    }

    bool isDivisible(const Reference& reference) const { return splits_.divisible[reference.primitive]; }

    /// The part of a reference below (or above) a plane.
    Reference partOf(const Reference& reference, int axis, float plane, bool below) const {
        Reference part = reference;
        (below ? part.bounds.upper : part.bounds.lower)[axis] = plane;
        part.bounds = clipped(splits_.triangles[part.primitive], part.bounds);
        return part;
    }

    /// Adds the parts of a reference to all bins that it crosses.
    void addParts(const Axis& axis, Reference reference, Bins& bins) const {
        const uint32_t first = axis.binOf(reference.bounds.lower[axis.axis]);
        const uint32_t last = axis.binOf(reference.bounds.upper[axis.axis]);
        if (!isDivisible(reference)) {
            Bin& bin = bins[axis.binOf(reference.bounds.center()[axis.axis])];
            bin.bounds.grow(Box4::of(reference.bounds));
            ++bin.first;
            ++bin.last;
            return;
        }
        ++bins[first].first;
        ++bins[last].last;
        for (uint32_t bin = first; bin < last; ++bin) {
            const float plane = axis.planeBefore(bin + 1);
            if (crosses(reference, axis.axis, plane)) {
                bins[bin].bounds.grow(Box4::of(partOf(reference, axis.axis, plane, true).bounds));
                reference = partOf(reference, axis.axis, plane, false);
            }
        }
        bins[last].bounds.grow(Box4::of(reference.bounds));
    }

    static bool crosses(const Reference& reference, int axis, float plane) {
        return reference.bounds.lower[axis] < plane && reference.bounds.upper[axis] > plane;
    }

    /// `other` is the best split without dividing triangles.
    Split spatialSplit(const Aabb& bounds, const Split& other, const Range& range) const {
        const Aabb left = other.leftBounds.aabb(), right = other.rightBounds.aabb();
        const Aabb overlap{glm::max(left.lower, right.lower), glm::min(left.upper, right.upper)};
        const vec3 size = overlap.size();
        Split best;
        if (glm::any(glm::lessThan(size, vec3(0.0f))) || !(overlap.halfArea() > leastOverlap_)) return best;
        for (int number = 0; number < 3; ++number) {
            const Axis axis(number, bounds.lower[number], bounds.upper[number]);
            if (!axis.usable(bounds.upper[number])) continue;
            const auto add = [&](const Reference& reference, Bins& bins) { addParts(axis, reference, bins); };
            chooseSplit(fillBins(in(range), 1u << 11, add), number, best);
        }
        if (best.axis >= 0 && best.left + best.right - range.count > range.room) return {};
        return best;
    }

    /// Whether all of a reference goes to one side, since that is cheaper than two parts.
    enum class Side { Left, Right, Both };
    static Side sideOf(const Reference& reference, const Split& split) {
        const auto grown = [&](Box4 box) {
            box.grow(Box4::of(reference.bounds));
            return box.halfArea();
        };
        const auto left = static_cast<float>(split.left), right = static_cast<float>(split.right);
        const float areaLeft = split.leftBounds.halfArea(), areaRight = split.rightBounds.halfArea();
        const float both = areaLeft * left + areaRight * right;
        const float onlyLeft = grown(split.leftBounds) * left + areaRight * (right - 1.0f);
        const float onlyRight = areaLeft * (left - 1.0f) + grown(split.rightBounds) * right;
        if (both <= std::min(onlyLeft, onlyRight)) return Side::Both;
        return onlyLeft <= onlyRight ? Side::Left : Side::Right;
    }

    Halves splitAt(const Split& split, const Aabb& bounds, const Range& range) {
        const Axis axis(split.axis, bounds.lower[split.axis], bounds.upper[split.axis]);
        const float plane = axis.planeBefore(split.bin + 1);
        uint32_t added = 0;
        const auto goesLeft = [&](Reference& reference) {
            if (!isDivisible(reference) || !crosses(reference, split.axis, plane))
                return axis.binOf(reference.bounds.center()[split.axis]) <= split.bin;
            const Side side = added < range.room ? sideOf(reference, split) : Side::Left;
            if (side != Side::Both) return side == Side::Left;
            references_[range.first + range.count + added++] = partOf(reference, split.axis, plane, false);
            reference = partOf(reference, split.axis, plane, true);
            return true;
        };
        const std::span<Reference> all = in(range);
        // In order, and each once: std::partition may not change what it visits.
        std::vector<Reference> right;
        auto left = all.begin();
        for (Reference& reference : all) {
            if (goesLeft(reference))
                *left++ = reference;
            else
                right.push_back(reference);
        }
        std::copy(right.begin(), right.end(), left);
        const auto lefts = static_cast<uint32_t>(left - all.begin());
        const Range longer{range.first, range.count + added, range.room - added};
        if (lefts == 0 || lefts == longer.count) return halvedAgain(longer);
        return divided(longer, lefts);
    }

    Halves halvedAgain(const Range& range) { return halved(boxesOf(in(range)).centers.aabb(), range); }

    References references_;
    const Splits& splits_;
    uint32_t sahDepth_, partSize_;
    float leastOverlap_ = 0.0f;  ///< as an area
    BinaryTree nodes_;
    Progress progress_;
    std::atomic<uint32_t> placed_{0};
    std::atomic<uint32_t> used_{1};  ///< nodes, where leaves are parts
};

}  // namespace

BinaryTree buildBinaryTree(References references, uint32_t sahDepth, const Splits& splits,
                           const Progress& progress) {
    return Builder(std::move(references), sahDepth, splits, 1, progress).take();
}

TreeTop buildTreeTop(References references, uint32_t sahDepth, uint32_t partSize, const Progress& progress) {
    return Builder(std::move(references), sahDepth, {}, std::max(partSize, 2u), progress).takeTop();
}

}  // namespace limpid::scene
