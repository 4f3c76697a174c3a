// Converts glTF animations to clips.
//
// Specification: glTF 2.0, section 3.11 (animations),
// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#animations
#pragma once

#include <vector>

#include "scene/gltf/document/gltf_document.h"

namespace limpid::scene::gltf {

/// Reads all animations of the document. `nodes` are its nodes, by index. Throws InputError if times are not
/// finite, negative or not strictly increasing, if the number of values does not match the times, or if an
/// index is out of range, or if the clips together have too many numbers for the document's size: many
/// channels may use the same data, and each has its own copy. Channels of extensions, without a target, or of
/// nodes placed by a matrix are ignored with a warning.
std::vector<Clip> readAnimations(Document& document, const std::vector<Node>& nodes);

}  // namespace limpid::scene::gltf
