// Roughly where in a box there is something: a grid of cells. For questions that a few hundred rays answer
// well enough.
#pragma once

#include <cstddef>
#include <vector>

#include "base/math.h"

namespace limpid::scene {

class Occupancy {
  public:
    /// Of a box that is not empty; `cells` along its longest side, at least 1.
    Occupancy(const vec3& lower, const vec3& upper, int cells);

    /// What the triangle, which lies in the box, touches.
    void add(const vec3& a, const vec3& b, const vec3& c);

    /// Along the unit vector `direction` until something is there; 0 if the box ends first: there is nothing
    /// to see.
    float distanceToSomething(const vec3& eye, const vec3& direction) const;

    /// Whether all cells that are at most `cells` away along each axis are empty and in the box.
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
