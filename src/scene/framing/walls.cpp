#include "scene/framing/walls.h"

#include <cmath>

#include "scene/framing/scene_points.h"

namespace limpid::scene {
namespace {

/// A triangle belongs to a side of the box if its distance is below this fraction of the box's size.
constexpr float wallDistance = 0.05f;

}  // namespace

Walls findWalls(const Scene& scene, const Aabb& box) {
    const vec3 size = box.size();
    const auto isInside = [&](const vec3& point) {
        const vec3 margin = 2.0f * wallDistance * size;
        return glm::all(glm::greaterThan(point, box.lower + margin)) &&
               glm::all(glm::lessThan(point, box.upper - margin));
    };
    const auto cover = [&](Walls& walls, int axis, bool isUpper, float area, bool bothSides) {
        const float whole = size[(axis + 1) % 3] * size[(axis + 2) % 3];
        if (!(whole > 0.0f)) return;
        walls.covered[static_cast<size_t>(2 * axis + isUpper)] += std::abs(area) / whole;
        walls.facingInward += (isUpper ? -area : area) / whole;
        if (bothSides) walls.seenFromBehind += std::abs(area) / whole;
    };
    const auto add = [&](Walls& walls, const vec3& a, const vec3& b, const vec3& c,
                         const Material& material) {
        if (isInside(a) && isInside(b) && isInside(c)) {
            walls.somethingInside = true;
            walls.lightInside |= material.emission != vec3(0.0f);
            return;
        }
        const vec3 area = 0.5f * glm::cross(b - a, c - a);
        const vec3 low = glm::min(a, glm::min(b, c));
        const vec3 high = glm::max(a, glm::max(b, c));
        for (int axis = 0; axis < 3; ++axis) {
            const float near = wallDistance * size[axis];
            if (high[axis] <= box.lower[axis] + near)
                cover(walls, axis, false, area[axis], material.doubleSided);
            if (low[axis] >= box.upper[axis] - near)
                cover(walls, axis, true, area[axis], material.doubleSided);
        }
    };
    Walls walls = sumOver(scene, Walls{}, add);
    for (const PunctualLight& light : scene.lights)
        walls.lightInside |= light.kind != PunctualLight::Kind::Directional && isInside(light.position);
    return walls;
}

std::optional<vec3> openSide(const Walls& walls) {
    const bool left = walls.isWall(0), right = walls.isWall(1), back = walls.isWall(4),
               front = walls.isWall(5);
    if (!walls.isWall(2) || !walls.isWall(3) || left + right + back + front != 3) return std::nullopt;
    if (!front) return vec3(0, 0, 1);
    if (!back) return vec3(0, 0, -1);
    return right ? vec3(-1, 0, 0) : vec3(1, 0, 0);
}

}  // namespace limpid::scene
