// Converts tree nodes to the format that GPUs traverse faster (shaders/common/scene_layout.h).
#pragma once

#include <span>
#include <vector>

#include "base/math.h"

namespace limpid::scene {

/// `quantised` contains BvhNodes, layout::BVH_NODE_TEXELS each.
std::vector<uvec4> expandNodes(std::span<const uvec4> quantised);

}  // namespace limpid::scene
