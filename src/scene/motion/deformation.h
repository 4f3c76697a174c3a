// Deforms vertices: first morph targets, then a skin.
//
// Specification: glTF 2.0, sections 3.7.2.2 (morph targets) and 3.7.3 (skins),
// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#skins
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"

namespace limpid::scene {

/// The offsets of a morph target at weight 1. Each array is empty or has one entry per vertex.
struct MorphTarget {
    std::vector<vec3> positions, normals, tangents;
};

/// A mesh before morphing and skinning, and the data that moves its vertices.
struct Deformation {
    std::vector<vec3> positions;
    std::vector<vec3> normals;  ///< empty or one per vertex, as in Mesh
    std::vector<vec4> tangents;
    std::vector<MorphTarget> targets;
    std::vector<std::array<uint16_t, 4>> joints;  ///< empty, or one per vertex: indices into a skin's joints
    std::vector<vec4> weights;  ///< of the joints; they sum to 1, or all are 0: such a vertex does not move
};

struct DeformedVertices {
    std::vector<vec3> positions;
    std::vector<vec3> normals;   ///< not normalised
    std::vector<vec4> tangents;  ///< xyz not normalised
};

/// `morphWeights`: missing ones are 0. `joints`: each joint's matrix from rest position to world; empty: no
/// skin.
DeformedVertices deform(const Deformation& deformation, std::span<const float> morphWeights,
                        std::span<const mat4> joints);

}  // namespace limpid::scene
