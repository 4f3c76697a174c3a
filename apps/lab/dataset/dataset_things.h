// The things in a random room or still life (scene/builtin) that can move or shine: balls, tables, lamps.
#pragma once

#include <cstddef>
#include <vector>

#include "scene/model/aabb.h"
#include "scene/model/scene.h"

namespace limpid::cli {

/// Instances and point lights that belong together, such as a shade, its bulb and the light in it.
struct Thing {
    std::vector<size_t> instances, lights;  ///< indices into Scene::instances and Scene::lights
    scene::Aabb bounds;

    vec3 center() const { return bounds.center(); }
    float radius() const { return 0.5f * glm::length(bounds.size()); }
};

/// The room's walls, or what a still life stands on; null if there is neither.
const scene::Instance* surroundingsOf(const scene::Scene& scene);
scene::Aabb boundsOf(const scene::Scene& scene, const scene::Instance& instance);
bool isLamp(const scene::Scene& scene, const scene::Instance& instance);
/// Whether it has a lamp or a light.
bool shines(const scene::Scene& scene, const Thing& thing);

/// All but the surroundings, what the first camera is in, and directional lights.
std::vector<Thing> thingsOf(const scene::Scene& scene);

/// Moves the place so that it is at least `margin` away from the room's walls, or as far as `rest` where that
/// is closer to one. Returns it unchanged if there is no room.
vec3 withinWalls(const scene::Scene& scene, const vec3& place, const vec3& margin, const vec3& rest);

/// Half of the space that the things take, or where they are small, part of their distance from the camera.
float sizeOf(const scene::Scene& scene, const std::vector<Thing>& things);

}  // namespace limpid::cli
