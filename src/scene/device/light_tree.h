// A tree over the lights of a scene, from which shaders choose a light for a point
// (shaders/material/light_tree.glsl).
//
// Build: binned, by the surface area orientation heuristic of A. Conty Estevez, C. Kulla, "Importance
// sampling of many lights with adaptive tree splitting", HPG 2018. Pairs of levels are joined, so that a node
// has up to four children, whose weights are compared directly: the same number of weights as in a binary
// tree, but half the number of steps.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"
#include "scene/device/light_bounds.h"

namespace limpid::scene {

class LightTree {
  public:
    static constexpr uint32_t width = 4;
    static constexpr uint32_t maxDepth =
        32;  ///< nodes from the root to a leaf; a trail has two bits for each

    /// A child of a node: another node, or a light.
    struct Child {
        LightBounds bounds;
        uint32_t index = 0;  ///< of the node or light
        bool isLight = false;
        bool exists = false;
    };
    using Node = std::array<Child, width>;

    LightTree() = default;
    /// One leaf per element of `lights`, in the order of the light list. Leaves without intensity have a
    /// place, too.
    explicit LightTree(std::span<const LightBounds> lights);

    uint32_t lightCount() const { return static_cast<uint32_t>(trails_.size()); }
    /// The root is the first; children come after their parent. Empty without lights.
    const std::vector<Node>& nodes() const { return nodes_; }
    /// The way from the root to a light: two bits per node, the root's lowest: which child.
    uint64_t trail(uint32_t light) const { return trails_[light]; }

    /// Replaces the bounds of a light. Call refit() after the last one.
    void setLight(uint32_t light, const LightBounds& bounds);
    /// Updates the nodes above changed lights. The tree keeps its shape. Returns the indices of the nodes
    /// that changed, in ascending order.
    std::vector<uint32_t> refit();

  private:
    friend class LightTreeBuilder;
    std::vector<Node> nodes_;
    std::vector<uint32_t> parents_;  ///< of the nodes; the root's is itself
    std::vector<uint32_t> homes_;    ///< of the lights: node * width + child
    std::vector<uint64_t> trails_;
    std::vector<bool> dirty_;  ///< nodes with a changed child
};

/// Returns the number of texels of packLightTree() for a tree over that many lights, whatever its shape.
size_t lightTreeTexels(size_t lights);
/// Packs a node for shaders: layout::LIGHT_NODE_TEXELS texels, with bounds that contain the node's.
void packLightNode(const LightTree::Node& node, std::span<uvec4> texels);
/// Packs all nodes, padded to lightTreeTexels().
std::vector<uvec4> packLightTree(const LightTree& tree);

}  // namespace limpid::scene
