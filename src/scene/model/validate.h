// The invariants of scene.h, checked.
#pragma once

#include <optional>
#include <string>

#include "scene/model/scene.h"

namespace limpid::scene {

/// The first invariant that the scene breaks, as a sentence; nothing if it keeps them all. Checked: indices
/// and material slots in range, attribute lengths, finite positions and transforms (in object and in world
/// space), unit normals and tangents, texture sizes, finite and not negative radiometric values. A scene
/// without triangles, or without cameras, is accepted here.
std::optional<std::string> findFault(const Scene& scene);

}  // namespace limpid::scene
