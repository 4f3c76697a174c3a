// Checks the invariants of scene.h.
#pragma once

#include <optional>
#include <string>

#include "scene/model/scene.h"

namespace limpid::scene {

/// Coordinates are below this, in the world and in a mesh's own space. Tracers multiply three lengths, each
/// up to 3.5 times as long, which must not overflow.
inline constexpr float coordinateLimit = 1e12f;

/// Returns the first violated invariant as a sentence; none if the scene is valid. Checks that indices and
/// material slots are in range, attribute lengths, finite positions and transforms (in object and world
/// space), unit normals and tangents, texture sizes, and finite radiometric values that are not negative.
/// Accepts a scene without triangles or cameras.
std::optional<std::string> findFault(const Scene& scene);

}  // namespace limpid::scene
