// The node hierarchy of a glTF document: the transform of every node.
//
// Specification: glTF 2.0, section 3.5 (scenes and nodes),
// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#nodes-and-hierarchy
#pragma once

#include <vector>

#include "scene/gltf/document/gltf_document.h"

namespace limpid::scene::gltf {

struct NodeTree {
    std::vector<Node> nodes;    ///< at rest
    std::vector<int> order;     ///< all nodes, parents before their children
    std::vector<mat4> toWorld;  ///< of each node at rest, whether in the scene or not
    std::vector<bool> inScene;  ///< reachable from the default scene's nodes
};

/// Throws InputError if a node has two parents or is its own ancestor, or a transform is not finite. Accepts
/// trees of any depth: it does not recurse. Without a default scene, uses the first scene; without scenes,
/// all nodes.
NodeTree readNodes(const Document& document);

}  // namespace limpid::scene::gltf
