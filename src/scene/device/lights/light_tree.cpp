#include "scene/device/lights/light_tree.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "scene/device/pack.h"
#include "scene/device/trees/bvh.h"

namespace limpid::scene {
namespace {

constexpr uint32_t lightBins = 12;
/// Subtrees with at least this many lights are built in parallel.
constexpr uint32_t parallelLights = 2048;

/// The integral over the sphere of a Lambertian emitter's profile beyond a cone (M_Omega in the paper,
/// theta_e = pi/2), by the cosine of the cone's half angle.
double orientationMeasure(double cosine) {
    constexpr double pi64 = std::numbers::pi;
    const double spread = std::acos(std::clamp(cosine, -1.0, 1.0)), all = std::min(spread + pi64 / 2, pi64);
    const double sine = std::sin(spread);
    return 2.0 * pi64 * (1.0 - cosine) +
           pi64 / 2 * (2.0 * all * sine - std::cos(spread - 2.0 * all) - 2.0 * spread * sine + cosine);
}

/// What the heuristic needs to know of a set of lights. The set's directions are summed, not bounded: if they
/// were spread evenly over a cone of half angle t, the sum's length would be (1 + cos t) / 2.
struct LightSet {
    Aabb box;
    vec3 directions{0.0f};
    float intensity = 0.0f;
    uint32_t count = 0;

    void add(const LightSet& other) {
        box.grow(other.box);
        directions += other.directions;
        intensity += other.intensity;
        count += other.count;
    }
    float cost() const;
};

float LightSet::cost() const {
    constexpr uint32_t entries = 64;
    static const std::array<float, entries + 1> table = [] {
        std::array<float, entries + 1> result{};
        for (uint32_t i = 0; i <= entries; ++i)
            result[i] = static_cast<float>(orientationMeasure(2.0 * i / entries - 1.0));
        return result;
    }();
    if (!(intensity > 0.0f)) return 0.0f;
    const float together = std::min(glm::length(directions) / intensity, 1.0f);
    const float orientation = table[static_cast<uint32_t>(together * entries)];
    const vec3 size = box.size();
    // The diagonal keeps sets of zero area apart: lamps in a row, or two lamps.
    const float area = 2.0f * box.halfArea() + 0.1f * glm::dot(size, size);
    return intensity * orientation * area;
}

/// A light while the tree is built. It is split off by coordinates: its position and, for spots, its
/// direction.
struct SplitLight {
    LightSet set;
    std::array<float, 6> coordinates{};
    uint32_t index = 0;
    bool spot = false;
};

SplitLight splitLightOf(const LightBounds& light, uint32_t index) {
    SplitLight result;
    result.set.box.grow(light.center - vec3(light.radius));
    result.set.box.grow(light.center + vec3(light.radius));
    result.set.intensity = light.intensity;
    result.set.count = 1;
    const bool aimed = !light.twoSided && light.spread < pi;
    const vec3 direction = aimed ? light.axis : vec3(0.0f);
    result.set.directions = light.intensity * (0.5f + 0.5f * std::cos(light.spread)) * direction;
    for (int axis = 0; axis < 3; ++axis) {
        result.coordinates[static_cast<size_t>(axis)] = light.center[axis];
        result.coordinates[static_cast<size_t>(axis) + 3] = direction[axis];
    }
    result.index = index;
    result.spot = light.spot;
    return result;
}

/// A node of a binary tree. The nodes of n lights take 2n - 1 places.
struct SplitNode {
    LightBounds bounds;
    float cost = 0.0f;
    uint32_t left = 0, right = 0;  ///< 0, 0: a leaf
    uint32_t light = 0;
};

/// The ranges of the coordinates of a set of lights, each divided into bins.
struct Ranges {
    std::array<float, 6> low, scale;  ///< scale 0: all lights are in one place
    uint32_t axes = 3;                ///< 6: directions, too
    int longest = 0;                  ///< of the first three

    explicit Ranges(std::span<const SplitLight> lights);
    uint32_t binOf(const SplitLight& light, size_t axis) const {
        const float position = (light.coordinates[axis] - low[axis]) * scale[axis];
        return std::min(static_cast<uint32_t>(position), lightBins - 1);
    }
};

Ranges::Ranges(std::span<const SplitLight> lights) {
    std::array<float, 6> high = lights[0].coordinates;
    low = lights[0].coordinates;
    for (const SplitLight& light : lights) {
        if (light.spot) axes = 6;
        for (size_t axis = 0; axis < 6; ++axis) {
            low[axis] = std::min(low[axis], light.coordinates[axis]);
            high[axis] = std::max(high[axis], light.coordinates[axis]);
        }
    }
    for (size_t axis = 0; axis < 6; ++axis) {
        const float bins = float{lightBins} / (high[axis] - low[axis]);
        scale[axis] = std::isfinite(bins) ? bins : 0.0f;
        if (axis < 3 &&
            high[axis] - low[axis] > high[static_cast<size_t>(longest)] - low[static_cast<size_t>(longest)])
            longest = static_cast<int>(axis);
    }
}

}  // namespace

class LightTreeBuilder {
  public:
    LightTreeBuilder(std::span<const LightBounds> lights, LightTree& tree)
        : lights_(lights), tree_(tree), nodes_(2 * lights.size()) {
        tree_.trails_.resize(lights.size(), uvec4(0u));
        tree_.homes_.resize(lights.size(), layout::NONE);
        order_.reserve(lights.size());
    }

    void build(size_t firstLamp) {
        std::vector<uint32_t> root;
        addTo(root, 0, firstLamp, width);
        addTo(root, firstLamp, lights_.size(), LightTree::maxRootLamps);
        if (!root.empty()) collapse(root);
    }

  private:
    static constexpr size_t width = layout::LIGHT_NODE_WIDTH;

    struct Split {
        size_t axis = 0;
        uint32_t bin = 0;
        float cost = std::numeric_limits<float>::infinity();
    };

    /// Builds a tree of the lights from `first` to `end`, whose top becomes up to `room` children of the
    /// root.
    void addTo(std::vector<uint32_t>& root, size_t first, size_t end, size_t room) {
        const auto start = static_cast<uint32_t>(order_.size());
        for (size_t i = first; i < end; ++i)
            if (lights_[i].inTree) order_.push_back(splitLightOf(lights_[i], static_cast<uint32_t>(i)));
        const auto count = static_cast<uint32_t>(order_.size()) - start;
        if (count == 0) return;
        split(start, count, 2 * start, 1);
        const std::vector<uint32_t> children = childrenOf(2 * start, room);
        root.insert(root.end(), children.begin(), children.end());
    }

    /// Builds the subtree of `count` lights from `first` into nodes_ from `at`.
    void split(uint32_t first, uint32_t count, uint32_t at, uint32_t depth) {
        SplitNode& node = nodes_[at];
        if (count == 1) {
            node.light = order_[first].index;
            node.bounds = lights_[node.light];
            node.cost = order_[first].set.cost();
            return;
        }
        LightSet whole;
        for (uint32_t i = first; i < first + count; ++i) whole.add(order_[i].set);
        node.cost = whole.cost();
        const uint32_t left = divide(std::span(order_).subspan(first, count), depth);
        node.left = at + 1;
        node.right = at + 2 * left;
        const auto buildLeft = [&] { split(first, left, node.left, depth + 1); };
        const auto buildRight = [&] { split(first + left, count - left, node.right, depth + 1); };
        if (count >= parallelLights) {
            tbb::parallel_invoke(buildLeft, buildRight);
        } else {
            buildLeft();
            buildRight();
        }
        node.bounds = unite(nodes_[node.left].bounds, nodes_[node.right].bounds);
    }

    /// Returns the number of lights that go to the left. Uneven splits are allowed as long as even ones can
    /// finish within the depth that a trail describes.
    static uint32_t divide(std::span<SplitLight> lights, uint32_t depth) {
        if (lights.size() == 2) return 1;
        const Ranges ranges(lights);
        const auto needed = static_cast<uint32_t>(std::bit_width(lights.size() - 1));
        if (depth + needed < LightTree::maxDepth) {
            const Split best = bestSplit(lights, ranges);
            if (std::isfinite(best.cost)) {
                const auto right = std::partition(lights.begin(), lights.end(), [&](const SplitLight& light) {
                    return ranges.binOf(light, best.axis) <= best.bin;
                });
                return static_cast<uint32_t>(right - lights.begin());
            }
        }
        const auto middle = lights.begin() + static_cast<std::ptrdiff_t>(lights.size() / 2);
        const auto axis = static_cast<size_t>(ranges.longest);
        std::ranges::nth_element(lights, middle, {}, [&](const SplitLight& light) {
            return std::pair(light.coordinates[axis], light.index);
        });
        return static_cast<uint32_t>(lights.size() / 2);
    }

    static Split bestSplit(std::span<const SplitLight> lights, const Ranges& ranges) {
        std::array<std::array<LightSet, lightBins>, 6> bins;
        for (const SplitLight& light : lights) {
            for (size_t axis = 0; axis < ranges.axes; ++axis)
                bins[axis][ranges.binOf(light, axis)].add(light.set);
        }
        Split best;
        for (size_t axis = 0; axis < ranges.axes; ++axis) {
            if (ranges.scale[axis] == 0.0f) continue;
            // K_r of the paper: prefers to divide long sets across.
            const float shape =
                axis < 3 ? ranges.scale[axis] / ranges.scale[static_cast<size_t>(ranges.longest)] : 1.0f;
            std::array<LightSet, lightBins> after = bins[axis];
            for (uint32_t i = lightBins - 1; i > 0; --i) after[i - 1].add(after[i]);
            LightSet before;
            for (uint32_t i = 0; i + 1 < lightBins; ++i) {
                before.add(bins[axis][i]);
                if (bins[axis][i].count == 0 || after[i + 1].count == 0) continue;
                const float cost = shape * (before.cost() + after[i + 1].cost());
                if (cost < best.cost) best = {axis, i, cost};
            }
        }
        return best;
    }

    /// Joins levels of the binary trees.
    void collapse(const std::vector<uint32_t>& root) {
        struct Task {
            std::vector<uint32_t> children;
            uint32_t parent, depth;
            uvec4 trail;
        };
        std::vector<Task> tasks{{root, 0, 0, uvec4(0u)}};
        for (size_t done = 0; done < tasks.size(); ++done) {
            const Task task = std::exchange(tasks[done], {});
            const auto node = static_cast<uint32_t>(done);
            const auto first = static_cast<uint32_t>(tree_.children_.size());
            if (node > 0) tree_.children_[task.parent].index = first;
            tree_.nodes_.push_back({first, task.parent});
            for (uint32_t slot = 0; slot < task.children.size(); ++slot) {
                const SplitNode& from = nodes_[task.children[slot]];
                const bool isLight = from.left == 0, last = slot + 1 == task.children.size();
                const uvec4 trail = trailWith(task.trail, task.depth, slot);
                if (isLight) {
                    tree_.trails_[from.light] = trail;
                    tree_.homes_[from.light] = first + slot;
                } else {
                    tasks.push_back(
                        {childrenOf(task.children[slot], width), first + slot, task.depth + 1, trail});
                }
                tree_.children_.push_back({from.bounds, from.light, node, isLight, last});
            }
        }
    }

    static uvec4 trailWith(uvec4 trail, uint32_t depth, uint32_t slot) {
        const uint32_t bit =
            depth == 0 ? 0 : layout::LIGHT_TRAIL_ROOT_BITS + (depth - 1) * layout::LIGHT_TRAIL_BITS;
        const uint64_t placed = uint64_t{slot} << bit % 32;
        const auto word = static_cast<int>(bit / 32);
        trail[word] |= static_cast<uint32_t>(placed);
        if (word < 3) trail[word + 1] |= static_cast<uint32_t>(placed >> 32);
        return trail;
    }

    /// Replaces the costliest child by its children as long as there is room.
    std::vector<uint32_t> childrenOf(uint32_t split, size_t room) const {
        if (nodes_[split].left == 0) return {split};
        std::vector<uint32_t> children{nodes_[split].left, nodes_[split].right};
        while (children.size() < room) {
            const auto costliest = std::ranges::max_element(children, {}, [&](uint32_t child) {
                return nodes_[child].left == 0 ? -1.0f : nodes_[child].cost;
            });
            const SplitNode& node = nodes_[*costliest];
            if (node.left == 0) break;
            *costliest = node.left;
            children.push_back(node.right);
        }
        return children;
    }

    std::span<const LightBounds> lights_;
    LightTree& tree_;
    std::vector<SplitLight> order_;
    std::vector<SplitNode> nodes_;
};

LightTree::LightTree(std::span<const LightBounds> lights, size_t firstLamp) {
    LightTreeBuilder(lights, *this).build(firstLamp);
}

void LightTree::setLight(uint32_t light, const LightBounds& bounds) {
    if (homes_[light] == layout::NONE) return;
    children_[homes_[light]].bounds = bounds;
    changed_.push_back(homes_[light]);
}

std::vector<uint32_t> LightTree::refit() {
    std::vector<bool> dirty(nodes_.size());
    for (const uint32_t child : changed_) dirty[children_[child].node] = true;
    for (auto i = static_cast<uint32_t>(nodes_.size()); i-- > 1;) {
        if (!dirty[i]) continue;
        const uint32_t parent = nodes_[i].parent;
        uint32_t child = nodes_[i].first;
        LightBounds all = children_[child].bounds;
        while (!children_[child].last) all = unite(all, children_[++child].bounds);
        children_[parent].bounds = all;
        changed_.push_back(parent);
        dirty[children_[parent].node] = true;
    }
    std::vector<uint32_t> changed = std::exchange(changed_, {});
    std::ranges::sort(changed);
    changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
    return changed;
}

namespace {

/// The upper half of a float's bits, rounded up.
uint32_t halfBitsAbove(float value) {
    const uint32_t word = bits(value);
    return std::isinf(value) ? word >> 16 : (word + 0xFFFFu) >> 16;
}

/// sin(angle / 2) in 16 bits, rounded up: precise for narrow cones, too.
uint32_t packAngle(float angle) {
    const double sine = std::sin(0.5 * std::clamp(double{angle}, 0.0, std::numbers::pi));
    return static_cast<uint32_t>(std::ceil(std::min(sine, 1.0) * 65535.0));
}

}  // namespace

void packLightChild(const LightTree::Child& child, std::span<uvec4> texels) {
    // The packed axis is off by up to half a step of 1 / 32,767 in both coordinates.
    constexpr float axisError = 8e-5f;
    // A narrower ramp would vanish in the shader's rounding.
    constexpr float minFalloff = 0.02f;
    const LightBounds& b = child.bounds;
    uint32_t link = child.index;
    if (child.isLight) link |= layout::LIGHT_LINK_LEAF;
    if (child.last) link |= layout::LIGHT_LINK_LAST;
    if (b.twoSided) link |= layout::LIGHT_LINK_TWO_SIDED;
    uint32_t angles = packAngle(b.spread + axisError) | packAngle(std::max(b.falloff, minFalloff)) << 16;
    if (b.spot) {
        link |= layout::LIGHT_LINK_SPOT;
        // A spot's packed angles are those of its inner and outer cone.
        angles = packAngle(b.spread) | packAngle(b.spread + b.falloff + axisError) << 16;
    }
    texels[0] = bits(b.center, halfBitsAbove(b.radius) << 16 | halfBitsAbove(b.range));
    texels[1] = {packDirection(b.axis), angles, bits(b.intensity), link};
}

size_t lightTreeTexels(size_t lights) {
    // Every node but the root is a child, and has at least two.
    return 2 * lights * layout::LIGHT_CHILD_TEXELS;
}

std::vector<uvec4> packLightTree(const LightTree& tree) {
    constexpr size_t step = layout::LIGHT_CHILD_TEXELS;
    std::vector<uvec4> texels(lightTreeTexels(tree.lightCount()));
    for (size_t i = 0; i < tree.children().size(); ++i)
        packLightChild(tree.children()[i], std::span(texels).subspan(i * step, step));
    return texels;
}

}  // namespace limpid::scene
