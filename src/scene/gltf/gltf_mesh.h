// Converts glTF primitives to meshes. Primitives that share their accessors become one scene::Mesh.
//
// Specification: glTF 2.0, section 3.7.2 (meshes),
// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#meshes
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scene/gltf/document/gltf_document.h"
#include "scene/gltf/rig/gltf_pose.h"

namespace limpid::scene::gltf {

/// Builds each distinct primitive once, in Scene::meshes. Throws InputError for invalid data (an index or
/// accessor out of range, arrays of different lengths, a position that is not finite) and if a document
/// expands to more than `maxVertices` or `maxTriangles`.
class MeshLibrary {
  public:
    MeshLibrary(Document& document, Scene& scene) : document_(document), scene_(scene) {}

    /// Returns the mesh's index in Scene::meshes; `none` if the primitive has no triangles (points, lines,
    /// nothing).
    int add(const Object& primitive, const std::string& name, const Pose& pose);

    /// Adds a copy of a mesh with its vertices transformed by `transform`, without normals: for transforms
    /// that have no inverse, which tracing needs. If the scene becomes too large, the error names `node`.
    int flatten(const Object& node, int mesh, const mat4& transform);

    static constexpr uint64_t maxVertices = uint64_t{1} << 27;
    static constexpr uint64_t maxTriangles = uint64_t{1} << 27;

  private:
    struct Source;
    Source readSource(const Object& primitive) const;
    int build(const Object& primitive, const Source& source, const std::string& name, const Pose& pose);
    void applyPose(const Object& primitive, const Pose& pose, Mesh& mesh);
    void setAttributes(const Object& primitive, const Source& source, Mesh& mesh) const;
    void setIndices(const Object& primitive, const Source& source, Mesh& mesh) const;
    void spend(const Object& blamed, uint64_t vertices, uint64_t triangles);

    Document& document_;
    Scene& scene_;
    std::map<std::vector<int64_t>, int> known_;  ///< maps accessors, mode and pose to a mesh
    uint64_t vertices_ = 0;
    uint64_t triangles_ = 0;
};

}  // namespace limpid::scene::gltf
