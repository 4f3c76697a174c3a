// Scenes made by code: always there, with known properties.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/model/scene.h"

namespace limpid::scene {

/// Names accepted after "builtin:", each with a line about it.
struct BuiltinInfo {
    std::string name, help;
};
std::vector<BuiltinInfo> builtinScenes();

/// By name; "room-N" is randomRoom(N) (random_room.h). Throws UsageError listing the names if there is no
/// such scene.
Scene builtinScene(std::string_view name);

/// The Cornell box with its measured dimensions (www.graphics.cornell.edu/online/box/data.html) in metres,
/// Lambertian, 36 triangles.
Scene cornellScene();
/// The Cornell box with a glass, a mirror and a glossy sphere in place of the blocks.
Scene cornellSpheresScene();
/// The Cornell box where the short block slides and turns, and a second light swings under the ceiling: one
/// clip, "moving", of 4 s, that ends as it began.
Scene cornellMovingScene();
/// About 300,000 triangles of spheres and rings in a closed, lit, Lambertian room.
Scene heavyScene();
/// A closed Lambertian room of the given albedo with a box in it; every surface emits 1 on both sides. Paths
/// of depth D see (1 - albedo^(D+1)) / (1 - albedo) everywhere.
Scene furnaceScene(float albedo = 0.5f);
// The laboratory's scenes are in builtin_lab.h.

}  // namespace limpid::scene
