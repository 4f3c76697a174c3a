#include "scene/prepare/expanded_nodes.h"

#include <algorithm>
#include <array>
#include <bit>

#include "scene/device/trees/bvh.h"
#include "shaders/common/scene_layout.h"

namespace limpid::scene {

std::vector<uvec4> expandNodes(std::span<const uvec4> quantised) {
    std::vector<uvec4> result;
    const size_t count = quantised.size() / layout::BVH_NODE_TEXELS;
    result.reserve(count * layout::EXPANDED_NODE_TEXELS);
    for (size_t n = 0; n < count; ++n) {
        std::array<uvec4, layout::BVH_NODE_TEXELS> texels;
        std::copy_n(quantised.begin() + static_cast<std::ptrdiff_t>(n * texels.size()), texels.size(),
                    texels.begin());
        const auto node = std::bit_cast<BvhNode>(texels);
        std::array<vec4, 6> planes;
        for (uint32_t child = 0; child < 4; ++child) {
            const Aabb box = node.hasChild(child) ? node.childBounds(child) : Aabb{vec3(1e30f), vec3(-1e30f)};
            for (int axis = 0; axis < 3; ++axis) {
                planes[static_cast<size_t>(axis)][static_cast<int>(child)] = box.lower[axis];
                planes[static_cast<size_t>(axis) + 3][static_cast<int>(child)] = box.upper[axis];
            }
        }
        for (const vec4& plane : planes) result.push_back(std::bit_cast<uvec4>(plane));
        result.emplace_back(node.children[0], node.children[1], node.children[2], node.children[3]);
    }
    return result;
}

}  // namespace limpid::scene
