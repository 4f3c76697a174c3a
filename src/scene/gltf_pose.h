// The rest pose of morphed and skinned primitives, applied to the vertices on the CPU.
//
// Specification: glTF 2.0, sections 3.7.2.2 (morph targets) and 3.7.3 (skins),
// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#skins
#pragma once

#include <memory>
#include <vector>

#include "scene/gltf_document.h"

namespace limpid::scene::gltf {

/// How a node poses the primitives of its mesh.
struct Pose {
    std::vector<float> weights;                 ///< of the morph targets; missing ones are 0
    int skin = none;                            ///< index of the skin
    const std::vector<mat4>* joints = nullptr;  ///< of that skin: rest position -> world
};

/// Adds the weighted morph targets of `primitive` to positions, normals and tangents; normals are left
/// unnormalised. Throws InputError if a target has another length than the mesh.
void applyMorphTargets(const Document& document, const Object& primitive, const std::vector<float>& weights,
                       Mesh& mesh);

/// Moves the vertices by their joints (JOINTS_0, WEIGHTS_0), into world space. Throws InputError if the
/// primitive has no joints or weights, or a joint is out of range.
void applySkin(const Document& document, const Object& primitive, const std::vector<mat4>& joints,
               Mesh& mesh);

}  // namespace limpid::scene::gltf
