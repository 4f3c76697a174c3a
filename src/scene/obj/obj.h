// Loads Wavefront OBJ and MTL files.
//
// Format: B1. Object Files, and MTL material format, Alias|Wavefront Advanced Visualizer manual, appendix B.
#pragma once

#include <filesystem>

#include "scene/load/load_options.h"
#include "scene/model/scene.h"

namespace limpid::scene {

/// Each group or object ("g", "o") becomes one Mesh with one Instance; its triangles may use several
/// materials (Mesh::materialSlots). Triangulates polygons, and flips texture coordinates so that v = 0 is at
/// the top. Uses normals if present; does not compute smoothing groups. Six numbers after "v" are a position
/// and a linear colour. Skips lines, points, curves and surfaces. Materials: see obj_material.h.
///
/// Throws InputError naming file, line and fault: an invalid or infinite number, an index out of range, no
/// triangles. Warns, and uses a plain colour, if a material file, material name or texture is missing or
/// rejected.
Scene loadObj(const std::filesystem::path& file, const LoadOptions& options = {});

}  // namespace limpid::scene
