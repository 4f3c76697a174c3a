#include "scene/gltf/rig/gltf_nodes.h"

#include <fmt/format.h>

#include "scene/prepare/mesh_repair.h"

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

Node readNode(const Object& source) {
    Node node;
    node.name = source.text("name");
    node.weights = source.numbers("weights");
    if (source.has("matrix")) {
        node.matrix = affine(source);
        return node;
    }
    node.translation = source.vector("translation", vec3(0.0f));
    node.scale = source.vector("scale", vec3(1.0f));
    const vec4 rotation = source.vector("rotation", vec4(0, 0, 0, 1));
    const float length = glm::length(rotation);
    // A quaternion of zeros is no rotation.
    if (length > 1e-20f && length < 1e18f) {
        node.rotation = glm::quat(rotation.w, rotation.x, rotation.y, rotation.z) / length;
    }
    return node;
}

bool isFinite(const mat4& m) {
    return scene::isFinite(m[0]) && scene::isFinite(m[1]) && scene::isFinite(m[2]) && scene::isFinite(m[3]);
}

Children readChildren(const std::vector<Object>& nodes, std::vector<Node>& read) {
    Children children(nodes.size());
    for (size_t i = 0; i < nodes.size(); ++i) {
        children[i] = nodes[i].indices("children", nodes.size());
        for (const int child : children[i]) {
            int& known = read[static_cast<size_t>(child)].parent;
            if (known != none) {
                nodes[i].fail("children", fmt::format("node {} already has the parent {}", child, known));
            }
            known = static_cast<int>(i);
        }
    }
    return children;
}

/// Returns parents before children. Nodes on a cycle are unreachable from roots and are missing.
std::vector<int> topDown(const std::vector<Node>& nodes, const Children& children) {
    std::vector<int> order;
    for (size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].parent == none) order.push_back(static_cast<int>(i));
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

std::vector<bool> markScene(const Document& document, const std::vector<Node>& nodes,
                            const std::vector<int>& order) {
    const size_t count = nodes.size();
    const auto& scenes = document.lists().scenes;
    std::vector<bool> inScene(count, scenes.empty());
    if (scenes.empty()) return inScene;
    const int chosen = document.root().index("scene", scenes.size());
    const Object& scene = scenes[chosen == none ? 0 : static_cast<size_t>(chosen)];
    for (const int root : scene.indices("nodes", count)) inScene[static_cast<size_t>(root)] = true;
    for (const int i : order) {
        const int above = nodes[static_cast<size_t>(i)].parent;
        if (above != none && inScene[static_cast<size_t>(above)]) inScene[static_cast<size_t>(i)] = true;
    }
    return inScene;
}

}  // namespace

NodeTree readNodes(const Document& document) {
    const auto& sources = document.lists().nodes;
    NodeTree tree;
    for (const Object& source : sources) tree.nodes.push_back(readNode(source));
    const Children children = readChildren(sources, tree.nodes);
    tree.order = topDown(tree.nodes, children);
    refuseCycle(sources, tree.order);
    tree.toWorld.resize(sources.size());
    for (const int index : tree.order) {
        const auto i = static_cast<size_t>(index);
        const mat4 local = tree.nodes[i].local();
        const int above = tree.nodes[i].parent;
        tree.toWorld[i] = above == none ? local : tree.toWorld[static_cast<size_t>(above)] * local;
        if (!isFinite(tree.toWorld[i])) sources[i].fail("its place in the world is not finite");
    }
    tree.inScene = markScene(document, tree.nodes, tree.order);
    return tree;
}

}  // namespace limpid::scene::gltf
