// A grid of cells that records roughly which parts of a box are occupied, for questions that a few hundred
// rays answer well enough.
#pragma once

#include <cstddef>
#include <vector>

#include "base/math.h"

namespace limpid::scene {

class Occupancy {
  public:
    /// Covers a box that is not empty, with `cells` cells along its longest side, at least 1.
    Occupancy(const vec3& lower, const vec3& upper, int cells);

    /// Marks the cells that the triangle touches. It must lie in the box.
    void add(const vec3& a, const vec3& b, const vec3& c);

    /// Returns the distance along the unit vector `direction` to the first occupied cell; 0 if the ray leaves
    /// the box first.
    float distanceToSomething(const vec3& eye, const vec3& direction) const;

    /// True if all cells within `cells` cells along each axis are empty and in the box.
    bool isFree(const vec3& point, int cells) const;

  private:
    ivec3 cellOf(const vec3& point) const { return ivec3(glm::floor((point - lower_) / cellSize_)); }
    bool inside(const ivec3& cell) const;
    size_t indexOf(const ivec3& cell) const;
    void mark(const vec3& point);

    vec3 lower_;
    float cellSize_;
    ivec3 count_;
    std::vector<bool> occupied_;
};

}  // namespace limpid::scene
