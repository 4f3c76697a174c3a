// Boxes along the axes.
#pragma once

#include <limits>

#include "base/math.h"

namespace limpid::scene {

struct Aabb {
    vec3 lower{std::numeric_limits<float>::max()};
    vec3 upper{std::numeric_limits<float>::lowest()};

    void grow(const vec3& point) {
        lower = glm::min(lower, point);
        upper = glm::max(upper, point);
    }
    void grow(const Aabb& other) {
        lower = glm::min(lower, other.lower);
        upper = glm::max(upper, other.upper);
    }
    bool empty() const { return lower.x > upper.x; }
    vec3 center() const { return 0.5f * lower + 0.5f * upper; }
    vec3 size() const { return upper - lower; }
    /// 0 to 7: its bits choose the upper end along x, y and z.
    vec3 corner(int i) const {
        return {i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z};
    }
    /// Half of the surface; 0 if empty.
    float halfArea() const {
        if (empty()) return 0.0f;
        const vec3 s = size();
        return s.x * s.y + s.y * s.z + s.z * s.x;
    }
};

}  // namespace limpid::scene
