// Reads how glTF primitives deform: their morph targets and skins. Checks every length and index.
//
// Specification: glTF 2.0, sections 3.7.2.2 (morph targets) and 3.7.3 (skins),
// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#skins
#pragma once

#include <vector>

#include "scene/gltf/document/gltf_document.h"

namespace limpid::scene::gltf {

/// How a node poses the primitives of its mesh at rest.
struct Pose {
    std::vector<float> weights;                 ///< of the morph targets; missing ones are 0
    int skin = none;                            ///< index of the skin
    const std::vector<mat4>* joints = nullptr;  ///< matrices of that skin, from rest position to world
};

/// Returns equally many matrices and joints. Throws InputError if the file has fewer matrices, or no joints.
Skin readSkin(const Document& document, const Object& source);

/// Reads the morph targets of `primitive`, and its joints and weights if `pose` has a skin. `mesh` has the
/// attributes of the file. Throws InputError if a target or an attribute has another length than the mesh, a
/// skinned primitive lacks JOINTS_0 or WEIGHTS_0, a joint is out of range, or a value is not finite.
Deformation readDeformation(Document& document, const Object& primitive, const Pose& pose, const Mesh& mesh);

}  // namespace limpid::scene::gltf
