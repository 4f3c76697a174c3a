// Tangents for meshes whose normal map comes without them.
#pragma once

#include "scene/model/scene.h"

namespace limpid::scene {

/// Sets mesh.tangents from texture coordinate set `uvSet` (0 or 1): the directions in which u grows, averaged
/// over the triangles around a vertex weighted by angle, as MikkTSpace does (Mikkelsen, "Simulation of
/// wrinkled surfaces revisited", 2008), perpendicular to the normal. w is +1 where cross(normal, tangent)
/// points up the picture (against v), -1 where the picture is mirrored; vertices between the two are split. A
/// mesh without normals gets flat ones, for which its vertices are split by triangle. Without texture
/// coordinates any perpendicular serves. mesh.deformation follows: it gets the same vertices, and normals and
/// tangents of the mesh at rest.
void generateTangents(Mesh& mesh, int uvSet);

}  // namespace limpid::scene
