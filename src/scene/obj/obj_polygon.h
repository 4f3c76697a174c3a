// Triangulates polygons.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"

namespace limpid::scene {

/// Returns corners.size() - 2 triangles (indices into `corners`, same orientation), by ear clipping. Convex
/// polygons become fans, and so do those that intersect themselves or have more than 256 corners. Needs at
/// least 3 corners.
std::vector<std::array<uint32_t, 3>> triangulate(std::span<const vec3> corners);

}  // namespace limpid::scene
