// A tree over the lights of a scene, from which shaders choose a light for a point
// (shaders/material/light_tree.glsl).
//
// Build: binned, by the surface area orientation heuristic of A. Conty Estevez, C. Kulla, "Importance
// sampling of many lights with adaptive tree splitting", HPG 2018. Levels of the binary tree are joined, so
// that a node has up to layout::LIGHT_NODE_WIDTH children, whose weights are compared directly: the fewer
// levels decide, the better. Up to maxRootLamps point and spot lights are children of the root, since bounds
// of several narrow cones say little.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"
#include "scene/device/lights/light_bounds.h"
#include "shaders/common/scene_layout.h"

namespace limpid::scene {

class LightTree {
  public:
    /// Nodes from the root to a leaf.
    static constexpr uint32_t maxDepth = 1 + (128 - layout::LIGHT_TRAIL_ROOT_BITS) / layout::LIGHT_TRAIL_BITS;
    static constexpr uint32_t maxRootLamps = layout::LIGHT_ROOT_CHILDREN - layout::LIGHT_NODE_WIDTH;

    /// A child of a node: another node, or a light. The children of a node are consecutive.
    struct Child {
        LightBounds bounds;
        uint32_t index = 0;  ///< of the light, or of the node's first child
        uint32_t node = 0;   ///< number of the node that it is a child of
        bool isLight = false;
        bool last = false;  ///< of the node
    };

    LightTree() = default;
    /// One leaf for each of `lights` that is in the tree, even without intensity. From `firstLamp` on they
    /// are point and spot lights.
    LightTree(std::span<const LightBounds> lights, size_t firstLamp);

    uint32_t lightCount() const { return static_cast<uint32_t>(trails_.size()); }
    /// The root's children come first; children of other nodes come after that node. Empty without lights.
    const std::vector<Child>& children() const { return children_; }
    /// The way from the root to a light: which child. The lowest layout::LIGHT_TRAIL_ROOT_BITS are for the
    /// root, then layout::LIGHT_TRAIL_BITS for each node.
    const uvec4& trail(uint32_t light) const { return trails_[light]; }

    /// Replaces the bounds of a light. Call refit() after the last one.
    void setLight(uint32_t light, const LightBounds& bounds);
    /// Updates the nodes above changed lights. The tree keeps its shape. Returns the indices of the children
    /// that changed since the last call, in ascending order.
    std::vector<uint32_t> refit();

  private:
    friend class LightTreeBuilder;
    struct Node {
        uint32_t first = 0;   ///< child
        uint32_t parent = 0;  ///< the child that stands for it; not used for the root
    };
    std::vector<Child> children_;
    std::vector<Node> nodes_;
    std::vector<uint32_t> homes_;  ///< of the lights: index of the child
    std::vector<uvec4> trails_;
    std::vector<uint32_t> changed_;
};

/// Returns the number of texels of packLightTree() for a tree over that many lights, whatever its shape.
size_t lightTreeTexels(size_t lights);
/// Packs a child for shaders: layout::LIGHT_CHILD_TEXELS texels, with bounds that contain the child's.
void packLightChild(const LightTree::Child& child, std::span<uvec4> texels);
/// Packs all children, padded to lightTreeTexels().
std::vector<uvec4> packLightTree(const LightTree& tree);

}  // namespace limpid::scene
