// Generates tangents for meshes that have a normal map but no tangents.
#pragma once

#include "scene/model/scene.h"

namespace limpid::scene {

/// Sets mesh.tangents from texture coordinate set `uvSet` (0 or 1): the directions of increasing u, averaged
/// over the triangles around a vertex weighted by angle, as MikkTSpace does (Mikkelsen, "Simulation of
/// wrinkled surfaces revisited", 2008), perpendicular to the normal. w is +1 if cross(normal, tangent) points
/// up the picture (against v), -1 if the picture is mirrored; vertices shared by both are split. A mesh
/// without normals gets flat ones, for which its vertices are split by triangle. Without texture coordinates,
/// uses any perpendicular. Updates mesh.deformation to the same vertices, with the normals and tangents of
/// the mesh at rest.
void generateTangents(Mesh& mesh, int uvSet);

}  // namespace limpid::scene
