// Polygons to triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"

namespace limpid::scene {

/// corners.size() - 2 triangles (indices into `corners`, same orientation), by cutting off ears; a convex
/// polygon becomes a fan, and so does one that is self-intersecting or has more than 256 corners. At least 3
/// corners.
std::vector<std::array<uint32_t, 3>> triangulate(std::span<const vec3> corners);

}  // namespace limpid::scene
