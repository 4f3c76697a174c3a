// Boxes of parts of triangles.
#pragma once

#include <array>

#include "scene/model/aabb.h"

namespace limpid::scene {

using Corners = std::array<vec3, 3>;

inline Aabb boxOf(const Corners& triangle) {
    Aabb box;
    for (const vec3& corner : triangle) box.grow(corner);
    return box;
}

/// The box of the part of a triangle that lies within a box. It lies within it, too, and is larger than the
/// part by no less than the rounding. `box` if rounding leaves nothing.
Aabb clipped(const Corners& triangle, const Aabb& box);

}  // namespace limpid::scene
