// Repairs common faults that every viewer accepts, so that scene.h's invariants hold.
#pragma once

#include <cstddef>
#include <string>

#include "scene/model/scene.h"

namespace limpid::scene {

struct Repairs {
    size_t rescaledNormals = 0;  ///< more than 1 % off unit length
    size_t recomputedNormals =
        0;                        ///< zero or not finite: replaced by the mean of the faces around the vertex
    size_t replacedTangents = 0;  ///< zero, not finite or along the normal: replaced by any perpendicular
    size_t zeroedValues = 0;      ///< texture coordinates and colours that are not finite

    bool any() const { return rescaledNormals + recomputedNormals + replacedTangents + zeroedValues > 0; }
    std::string describe() const;  ///< "2 normals not of unit length, ..."
};

/// Makes normals and tangents unit, tangents perpendicular with w = +-1, other attributes finite and colours
/// not negative. Positions and indices must already be valid (finite, in range).
Repairs repairAttributes(Mesh& mesh);

/// Returns the sum of the normals of each vertex's triangles, weighted by area, not normalised.
std::vector<vec3> sumFaceNormals(const Mesh& mesh);

/// Returns a unit vector perpendicular to the unit vector `n`.
vec3 anyPerpendicular(const vec3& n);

bool isFinite(const vec2& v);
bool isFinite(const vec3& v);
bool isFinite(const vec4& v);

/// Returns v / |v| without overflow; zero if v is zero or not finite.
vec3 safeNormalize(const vec3& v);

}  // namespace limpid::scene
