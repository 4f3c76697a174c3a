#include "scene/device/light_tree.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

#include "scene/device/bvh.h"
#include "scene/device/pack.h"

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

LightSet lightSetOf(const LightBounds& light) {
    LightSet bin;
    bin.box.grow(light.center - vec3(light.radius));
    bin.box.grow(light.center + vec3(light.radius));
    bin.intensity = light.intensity;
    const bool aimed = !light.twoSided && light.spread < pi;
    if (aimed) bin.directions = light.intensity * (0.5f + 0.5f * std::cos(light.spread)) * light.axis;
    bin.count = 1;
    return bin;
}

/// A node of the binary tree. Nodes of a range of n lights take 2n - 1 places.
struct SplitNode {
    LightBounds bounds;
    float cost = 0.0f;
    uint32_t left = 0, right = 0;  ///< 0, 0: a leaf
    uint32_t light = 0;
};

}  // namespace

class LightTreeBuilder {
  public:
    LightTreeBuilder(std::span<const LightBounds> lights, LightTree& tree)
        : lights_(lights), tree_(tree), order_(lights.size()), nodes_(2 * lights.size() - 1) {
        for (const LightBounds& light : lights) bins_.push_back(lightSetOf(light));
        std::iota(order_.begin(), order_.end(), 0u);
    }

    void build() {
        split(0, static_cast<uint32_t>(order_.size()), 0, 0);
        tree_.trails_.resize(lights_.size());
        tree_.homes_.resize(lights_.size());
        collapse();
        tree_.dirty_.resize(tree_.nodes_.size());
    }

  private:
    struct Split {
        int axis = -1;
        uint32_t bin = 0;
        float cost = std::numeric_limits<float>::infinity();
    };

    /// Builds the subtree of `count` lights from `first` into nodes_ from `at`.
    void split(uint32_t first, uint32_t count, uint32_t at, uint32_t depth) {
        SplitNode& node = nodes_[at];
        if (count == 1) {
            node.light = order_[first];
            node.bounds = lights_[node.light];
            node.cost = bins_[node.light].cost();
            return;
        }
        LightSet whole;
        for (uint32_t i = first; i < first + count; ++i) whole.add(bins_[order_[i]]);
        node.cost = whole.cost();
        const uint32_t left = divide(first, count, depth);
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
    uint32_t divide(uint32_t first, uint32_t count, uint32_t depth) {
        const auto begin = order_.begin() + first, end = begin + count;
        Aabb centers;
        for (auto it = begin; it != end; ++it) centers.grow(lights_[*it].center);
        const auto needed = static_cast<uint32_t>(std::bit_width(count - 1));
        if (depth + needed < LightTree::maxDepth) {
            const Split best = bestSplit(first, count, centers);
            if (best.axis >= 0) {
                const auto middle = std::partition(begin, end, [&](uint32_t light) {
                    return binIndex(light, best.axis, centers) <= best.bin;
                });
                return static_cast<uint32_t>(middle - begin);
            }
        }
        const vec3 size = centers.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        std::nth_element(begin, begin + count / 2, end, [&](uint32_t a, uint32_t b) {
            const float ca = lights_[a].center[axis], cb = lights_[b].center[axis];
            return ca != cb ? ca < cb : a < b;
        });
        return count / 2;
    }

    Split bestSplit(uint32_t first, uint32_t count, const Aabb& centers) const {
        Split best;
        const vec3 size = centers.size();
        const float longest = std::max({size.x, size.y, size.z});
        for (int axis = 0; axis < 3; ++axis) {
            if (!(size[axis] > 0.0f)) continue;
            std::array<LightSet, lightBins> bins;
            for (uint32_t i = first; i < first + count; ++i)
                bins[binIndex(order_[i], axis, centers)].add(bins_[order_[i]]);
            std::array<LightSet, lightBins> after = bins;
            for (uint32_t i = lightBins - 1; i > 0; --i) after[i - 1].add(after[i]);
            LightSet before;
            for (uint32_t i = 0; i + 1 < lightBins; ++i) {
                before.add(bins[i]);
                if (before.count == 0 || after[i + 1].count == 0) continue;
                // K_r of the paper: prefers to divide long sets across.
                const float cost = longest / size[axis] * (before.cost() + after[i + 1].cost());
                if (cost < best.cost) best = {axis, i, cost};
            }
        }
        return best;
    }

    uint32_t binIndex(uint32_t light, int axis, const Aabb& centers) const {
        const float low = centers.lower[axis], size = centers.upper[axis] - low;
        const float position = (lights_[light].center[axis] - low) / size * static_cast<float>(lightBins);
        return std::min(static_cast<uint32_t>(position), lightBins - 1);
    }

    /// Joins levels of the binary tree: a node takes the children of its costliest child until it has four.
    void collapse() {
        struct Task {
            uint32_t binary, parent, slot;
            uint64_t trail;
            uint32_t depth;
        };
        std::vector<Task> tasks{{0, 0, 0, 0, 0}};
        for (size_t done = 0; done < tasks.size(); ++done) {
            const Task task = tasks[done];
            const auto index = static_cast<uint32_t>(tree_.nodes_.size());
            if (index > 0) tree_.nodes_[task.parent][task.slot].index = index;
            tree_.parents_.push_back(task.parent);
            LightTree::Node& node = tree_.nodes_.emplace_back();
            uint32_t slot = 0;
            for (const uint32_t child : childrenOf(task.binary)) {
                const SplitNode& from = nodes_[child];
                const uint64_t trail = task.trail | uint64_t{slot} << (2 * task.depth);
                node[slot] = {from.bounds, from.light, from.left == 0, true};
                if (from.left == 0) {
                    tree_.trails_[from.light] = trail;
                    tree_.homes_[from.light] = index * LightTree::width + slot;
                } else {
                    tasks.push_back({child, index, slot, trail, task.depth + 1});
                }
                ++slot;
            }
        }
    }

    std::vector<uint32_t> childrenOf(uint32_t binary) const {
        if (nodes_[binary].left == 0) return {binary};  // a tree of one light
        std::vector<uint32_t> children{nodes_[binary].left, nodes_[binary].right};
        while (children.size() < LightTree::width) {
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
    std::vector<LightSet> bins_;  ///< of the lights
    std::vector<uint32_t> order_;
    std::vector<SplitNode> nodes_;
};

LightTree::LightTree(std::span<const LightBounds> lights) {
    if (!lights.empty()) LightTreeBuilder(lights, *this).build();
}

void LightTree::setLight(uint32_t light, const LightBounds& bounds) {
    const uint32_t home = homes_[light];
    nodes_[home / width][home % width].bounds = bounds;
    dirty_[home / width] = true;
}

std::vector<uint32_t> LightTree::refit() {
    std::vector<uint32_t> changed;
    for (auto i = static_cast<uint32_t>(nodes_.size()); i-- > 0;) {
        if (!dirty_[i]) continue;
        dirty_[i] = false;
        changed.push_back(i);
        if (i == 0) continue;
        LightBounds all;
        for (const Child& child : nodes_[i])
            if (child.exists) all = unite(all, child.bounds);
        for (Child& child : nodes_[parents_[i]])
            if (child.exists && !child.isLight && child.index == i) child.bounds = all;
        dirty_[parents_[i]] = true;
    }
    std::ranges::reverse(changed);
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

void packLightNode(const LightTree::Node& node, std::span<uvec4> texels) {
    // The packed axis is off by up to half a step of 1 / 32,767 in both coordinates.
    constexpr float axisError = 8e-5f;
    // A narrower ramp would vanish in the shader's rounding.
    constexpr float minFalloff = 0.02f;
    for (uint32_t i = 0; i < LightTree::width; ++i) {
        const LightTree::Child& child = node[i];
        const LightBounds& b = child.bounds;
        uvec4 &place = texels[2 * i], &effect = texels[2 * i + 1];
        place = effect = uvec4(0u);
        if (!child.exists) continue;
        place = bits(b.center, halfBitsAbove(b.radius) << 16 | halfBitsAbove(b.range));
        uint32_t link = child.index;
        if (child.isLight) link |= layout::LIGHT_LINK_LEAF;
        if (b.twoSided) link |= layout::LIGHT_LINK_TWO_SIDED;
        // A spot's packed angles are those of its inner and outer cone.
        uint32_t angles = packAngle(b.spread) | packAngle(b.spread + b.falloff + axisError) << 16;
        if (b.spot) {
            link |= layout::LIGHT_LINK_SPOT;
        } else {
            angles = packAngle(b.spread + axisError) | packAngle(std::max(b.falloff, minFalloff)) << 16;
        }
        effect = {packDirection(b.axis), angles, bits(b.intensity), link};
    }
}

size_t lightTreeTexels(size_t lights) {
    // Each node but the root replaces one entry of its parent by at least two.
    return std::max<size_t>(lights, 2) * layout::LIGHT_NODE_TEXELS - layout::LIGHT_NODE_TEXELS;
}

std::vector<uvec4> packLightTree(const LightTree& tree) {
    std::vector<uvec4> texels(lightTreeTexels(tree.lightCount()));
    for (size_t i = 0; i < tree.nodes().size(); ++i) {
        packLightNode(tree.nodes()[i],
                      std::span(texels).subspan(i * layout::LIGHT_NODE_TEXELS, layout::LIGHT_NODE_TEXELS));
    }
    return texels;
}

}  // namespace limpid::scene
