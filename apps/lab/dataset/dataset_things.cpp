#include "lab/dataset/dataset_things.h"

#include <algorithm>

#include "scene/model/transform.h"

namespace limpid::cli {
namespace {

bool contains(const scene::Aabb& box, const vec3& point) {
    return glm::all(glm::lessThanEqual(box.lower, point)) && glm::all(glm::lessThanEqual(point, box.upper));
}

vec3 eyeOf(const scene::Scene& scene) {
    return vec3(scene.cameras.front().toWorld[3]);
}

/// The thing around the point; null if there is none.
Thing* around(std::vector<Thing>& things, const vec3& point) {
    const auto found =
        std::ranges::find_if(things, [&](const Thing& thing) { return contains(thing.bounds, point); });
    return found == things.end() ? nullptr : &*found;
}

}  // namespace

const scene::Instance* surroundingsOf(const scene::Scene& scene) {
    const auto found = std::ranges::find_if(scene.instances, [](const scene::Instance& instance) {
        return instance.name == "room" || instance.name == "support";
    });
    return found == scene.instances.end() ? nullptr : &*found;
}

scene::Aabb boundsOf(const scene::Scene& scene, const scene::Instance& instance) {
    scene::Aabb bounds;
    for (const vec3& position : scene.meshes[static_cast<size_t>(instance.mesh)].positions)
        bounds.grow(scene::transformPoint(instance.transform, position));
    return bounds;
}

bool isLamp(const scene::Scene& scene, const scene::Instance& instance) {
    return scene::isEmitter(scene.materials[static_cast<size_t>(instance.material)]);
}

bool shines(const scene::Scene& scene, const Thing& thing) {
    return !thing.lights.empty() ||
           std::ranges::any_of(thing.instances, [&](size_t i) { return isLamp(scene, scene.instances[i]); });
}

std::vector<Thing> thingsOf(const scene::Scene& scene) {
    std::vector<Thing> things;
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const scene::Instance& instance = scene.instances[i];
        if (&instance == surroundingsOf(scene)) continue;
        const scene::Aabb bounds = boundsOf(scene, instance);
        Thing* shade = instance.name == "bulb" ? around(things, bounds.center()) : nullptr;
        if (!shade) shade = &things.emplace_back();
        shade->instances.push_back(i);
        shade->bounds.grow(bounds);
    }
    std::erase_if(things, [&](const Thing& thing) { return contains(thing.bounds, eyeOf(scene)); });
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const scene::PunctualLight& light = scene.lights[i];
        if (light.kind == scene::PunctualLight::Kind::Directional) continue;
        Thing* lamp = around(things, light.position);
        if (!lamp) lamp = &things.emplace_back();
        lamp->lights.push_back(i);
        lamp->bounds.grow(light.position);
    }
    return things;
}

vec3 withinWalls(const scene::Scene& scene, const vec3& place, const vec3& margin, const vec3& rest) {
    const scene::Instance* room = surroundingsOf(scene);
    if (!room || room->name != "room") return place;
    const scene::Aabb walls = boundsOf(scene, *room);
    return glm::clamp(place, glm::min(walls.lower + margin, rest), glm::max(walls.upper - margin, rest));
}

float sizeOf(const scene::Scene& scene, const std::vector<Thing>& things) {
    scene::Aabb all;
    for (const Thing& thing : things)
        if (!thing.instances.empty()) all.grow(thing.bounds);
    if (all.empty()) return 1.0f;
    const vec3 size = all.size();
    return std::max(0.5f * std::max(size.x, std::max(size.y, size.z)),
                    0.25f * glm::distance(all.center(), eyeOf(scene)));
}

}  // namespace limpid::cli
