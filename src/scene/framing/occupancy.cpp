#include "scene/framing/occupancy.h"

#include <algorithm>
#include <cmath>

namespace limpid::scene {
namespace {

/// Step of the rays and distance of sample points on a triangle, in cells; small enough to skip no cell.
constexpr float spacing = 0.5f;

}  // namespace

Occupancy::Occupancy(const vec3& lower, const vec3& upper, int cells) : lower_(lower) {
    const vec3 size = upper - lower;
    cellSize_ = std::max({size.x, size.y, size.z, 1e-20f}) / static_cast<float>(cells);
    count_ = glm::max(ivec3(glm::ceil(size / cellSize_ - 1e-3f)), ivec3(1));
    occupied_.resize(static_cast<size_t>(count_.x) * static_cast<size_t>(count_.y) *
                     static_cast<size_t>(count_.z));
}

bool Occupancy::inside(const ivec3& cell) const {
    return glm::all(glm::greaterThanEqual(cell, ivec3(0))) && glm::all(glm::lessThan(cell, count_));
}

size_t Occupancy::indexOf(const ivec3& cell) const {
    return (static_cast<size_t>(cell.z) * static_cast<size_t>(count_.y) + static_cast<size_t>(cell.y)) *
               static_cast<size_t>(count_.x) +
           static_cast<size_t>(cell.x);
}

void Occupancy::mark(const vec3& point) {
    occupied_[indexOf(glm::clamp(cellOf(point), ivec3(0), count_ - 1))] = true;
}

void Occupancy::add(const vec3& a, const vec3& b, const vec3& c) {
    const float longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    const int steps = std::max(static_cast<int>(std::ceil(longest / (spacing * cellSize_))), 1);
    for (int i = 0; i <= steps; ++i) {
        for (int j = 0; i + j <= steps; ++j) {
            const float u = static_cast<float>(i) / static_cast<float>(steps);
            const float v = static_cast<float>(j) / static_cast<float>(steps);
            mark(a + u * (b - a) + v * (c - a));
        }
    }
}

float Occupancy::distanceToSomething(const vec3& eye, const vec3& direction) const {
    for (float distance = 0.0f;; distance += spacing * cellSize_) {
        const ivec3 cell = cellOf(eye + distance * direction);
        if (!inside(cell)) return 0.0f;
        if (occupied_[indexOf(cell)]) return distance;
    }
}

bool Occupancy::isFree(const vec3& point, int cells) const {
    const ivec3 centre = cellOf(point);
    for (int z = -cells; z <= cells; ++z) {
        for (int y = -cells; y <= cells; ++y) {
            for (int x = -cells; x <= cells; ++x) {
                const ivec3 cell = centre + ivec3(x, y, z);
                if (!inside(cell) || occupied_[indexOf(cell)]) return false;
            }
        }
    }
    return true;
}

}  // namespace limpid::scene
