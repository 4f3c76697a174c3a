#include "scene/gltf_nodes.h"

#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "scene/mesh_repair.h"

namespace limpid::scene::gltf {
namespace {

using Children = std::vector<std::vector<int>>;

mat4 affine(const Object& node) {
    mat4 m = node.matrix("matrix");
    const vec4 bottom(m[0].w, m[1].w, m[2].w, m[3].w);
    if (!(glm::distance(bottom, vec4(0, 0, 0, 1)) < 1e-4f))
        node.fail("matrix", "is not affine: its last row must be 0 0 0 1");
    for (int c = 0; c < 4; ++c) m[c].w = c == 3 ? 1.0f : 0.0f;
    return m;
}

mat4 localTransform(const Object& node) {
    if (node.has("matrix")) return affine(node);
    const vec3 translation = node.vector("translation", vec3(0.0f));
    const vec4 rotation = node.vector("rotation", vec4(0, 0, 0, 1));
    const vec3 scale = node.vector("scale", vec3(1.0f));
    const float length = glm::length(rotation);
    // A quaternion of zeros turns nothing.
    const glm::quat turn = length > 1e-20f && length < 1e18f
                               ? glm::quat(rotation.w, rotation.x, rotation.y, rotation.z) / length
                               : glm::quat(1, 0, 0, 0);
    return glm::scale(glm::translate(mat4(1.0f), translation) * glm::mat4_cast(turn), scale);
}

bool isFinite(const mat4& m) {
    return scene::isFinite(m[0]) && scene::isFinite(m[1]) && scene::isFinite(m[2]) && scene::isFinite(m[3]);
}

Children readChildren(const std::vector<Object>& nodes, std::vector<int>& parent) {
    Children children(nodes.size());
    for (size_t i = 0; i < nodes.size(); ++i) {
        children[i] = nodes[i].indices("children", nodes.size());
        for (const int child : children[i]) {
            int& known = parent[static_cast<size_t>(child)];
            if (known != none) {
                nodes[i].fail("children", fmt::format("node {} already has the parent {}", child, known));
            }
            known = static_cast<int>(i);
        }
    }
    return children;
}

/// Parents before children. Nodes on a cycle have no root above them and are missing.
std::vector<int> topDown(const std::vector<int>& parent, const Children& children) {
    std::vector<int> order;
    for (size_t i = 0; i < parent.size(); ++i) {
        if (parent[i] == none) order.push_back(static_cast<int>(i));
    }
    for (size_t next = 0; next < order.size(); ++next) {
        const auto& below = children[static_cast<size_t>(order[next])];
        order.insert(order.end(), below.begin(), below.end());
    }
    return order;
}

void refuseCycle(const std::vector<Object>& nodes, const std::vector<int>& order) {
    if (order.size() == nodes.size()) return;
    std::vector<bool> reached(nodes.size());
    for (const int i : order) reached[static_cast<size_t>(i)] = true;
    for (size_t i = 0; i < nodes.size(); ++i) {
        if (!reached[i]) nodes[i].fail("is its own ancestor");
    }
}

std::vector<bool> markScene(const Document& document, const std::vector<int>& parent,
                            const std::vector<int>& order) {
    const size_t count = parent.size();
    const auto& scenes = document.lists().scenes;
    std::vector<bool> inScene(count, scenes.empty());
    if (scenes.empty()) return inScene;
    const int chosen = document.root().index("scene", scenes.size());
    const Object& scene = scenes[chosen == none ? 0 : static_cast<size_t>(chosen)];
    for (const int root : scene.indices("nodes", count)) inScene[static_cast<size_t>(root)] = true;
    for (const int i : order) {
        const int above = parent[static_cast<size_t>(i)];
        if (above != none && inScene[static_cast<size_t>(above)]) inScene[static_cast<size_t>(i)] = true;
    }
    return inScene;
}

}  // namespace

NodeTree readNodes(const Document& document) {
    const auto& nodes = document.lists().nodes;
    NodeTree tree;
    tree.parent.assign(nodes.size(), none);
    const Children children = readChildren(nodes, tree.parent);
    const std::vector<int> order = topDown(tree.parent, children);
    refuseCycle(nodes, order);
    tree.toWorld.resize(nodes.size());
    for (const int i : order) {
        const auto node = static_cast<size_t>(i);
        const mat4 local = localTransform(nodes[node]);
        const int above = tree.parent[node];
        tree.toWorld[node] = above == none ? local : tree.toWorld[static_cast<size_t>(above)] * local;
        if (!isFinite(tree.toWorld[node])) nodes[node].fail("its place in the world is not finite");
    }
    tree.inScene = markScene(document, tree.parent, order);
    return tree;
}

}  // namespace limpid::scene::gltf
