// Wavefront OBJ and MTL files to a Scene.
//
// Format: B1. Object Files, and MTL material format, Alias|Wavefront Advanced Visualizer manual, appendix B.
#pragma once

#include <filesystem>

#include "scene/model/load_options.h"
#include "scene/model/scene.h"

namespace limpid::scene {

/// Each group or object ("g", "o") becomes one Mesh with one Instance; its triangles may use several
/// materials (Mesh::materialSlots). Polygons are triangulated, texture coordinates turned to v = 0 at the
/// top. Normals are used where given; smoothing groups are not computed. Six numbers after "v" are a position
/// and a linear colour. Lines, points, curves and surfaces are skipped. Materials: see obj_material.h.
///
/// Throws InputError naming file, line and fault: a number that is none or not finite, an index out of range,
/// no triangles. A warning, and a plain colour: a material file or name that is missing or refused, a texture
/// that cannot be had.
Scene loadObj(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace limpid::scene
