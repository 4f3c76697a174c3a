// Which emissive triangles belong together. A lamp is a connected piece of them with one material: other
// pieces of the same mesh may be in another room.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/model/scene.h"

namespace limpid::scene {

/// With more point and spot lights, to evaluate all of them for each choice would take longer than the light
/// tree.
inline constexpr uint32_t maxEvaluatedLights = 256;

/// Numbers the lamps among some triangles of a mesh. Triangles belong together if they have one material and
/// share an edge, by the positions of its ends.
/// @param triangles  indices of triangles of the mesh
/// @return           the number of each one's lamp; numbers begin at 0 and have no gaps
std::vector<uint32_t> lampsOf(const Mesh& mesh, std::span<const uint32_t> triangles);

}  // namespace limpid::scene
