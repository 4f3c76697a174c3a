#include "scene/prepare/tangents.h"

#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "scene/prepare/mesh_repair.h"

namespace limpid::scene {
namespace {

template <typename Value>
void gather(std::vector<Value>& values, const std::vector<uint32_t>& from) {
    if (values.empty()) return;
    std::vector<Value> gathered;
    gathered.reserve(from.size());
    for (const uint32_t i : from) gathered.push_back(values[i]);
    values = std::move(gathered);
}

/// Makes vertex i a copy of the old vertex from[i].
void gatherVertices(Mesh& mesh, const std::vector<uint32_t>& from) {
    gather(mesh.positions, from);
    gather(mesh.normals, from);
    gather(mesh.uv0, from);
    gather(mesh.uv1, from);
    gather(mesh.colors, from);
}

/// Returns the old vertex that each new one copies.
std::vector<uint32_t> addFlatNormals(Mesh& mesh) {
    const std::vector<uint32_t> from = mesh.indices;
    gatherVertices(mesh, from);
    for (size_t i = 0; i < mesh.indices.size(); ++i) mesh.indices[i] = static_cast<uint32_t>(i);
    mesh.normals = sumFaceNormals(mesh);
    for (vec3& normal : mesh.normals) {
        normal = safeNormalize(normal);
        if (normal == vec3(0.0f)) normal = {0.0f, 1.0f, 0.0f};
    }
    return from;
}

struct Face {
    vec3 alongU{0.0f};  ///< unit, or zero if the texture coordinates are degenerate
    bool mirrored = false;
};

Face faceTangent(const Mesh& mesh, const std::vector<vec2>& uv, size_t first) {
    const uint32_t* corner = &mesh.indices[first];
    const vec3 e1 = mesh.positions[corner[1]] - mesh.positions[corner[0]];
    const vec3 e2 = mesh.positions[corner[2]] - mesh.positions[corner[0]];
    const vec2 d1 = uv[corner[1]] - uv[corner[0]];
    const vec2 d2 = uv[corner[2]] - uv[corner[0]];
    // v points down the picture, so an unmirrored picture has a negative area.
    const float area = d1.x * d2.y - d2.x * d1.y;
    if (area == 0.0f) return {};
    return {safeNormalize((e1 * d2.y - e2 * d1.y) * (area > 0.0f ? 1.0f : -1.0f)), area > 0.0f};
}

struct Split {
    std::vector<uint32_t> from;  ///< the old vertex that each new one copies
    std::vector<bool> mirrored;  ///< for each new vertex
};

/// Splits the vertices on edges between mirrored and unmirrored triangles.
Split splitMirrored(Mesh& mesh, const std::vector<Face>& faces) {
    constexpr uint32_t unset = ~0u;
    const size_t vertices = mesh.positions.size();
    std::vector<std::array<uint32_t, 2>> copies(vertices, {unset, unset});
    std::vector<uint32_t> from(vertices);
    for (size_t i = 0; i < vertices; ++i) from[i] = static_cast<uint32_t>(i);
    std::vector<bool> mirrored(vertices, false);
    for (size_t i = 0; i < mesh.indices.size(); ++i) {
        uint32_t& index = mesh.indices[i];
        const bool side = faces[i / 3].mirrored;
        uint32_t& copy = copies[index][side];
        if (copy == unset) {
            const bool isFirst = copies[index][!side] == unset;
            copy = isFirst ? index : static_cast<uint32_t>(from.size());
            if (!isFirst) {
                from.push_back(index);
                mirrored.push_back(false);
            }
            mirrored[copy] = side;
        }
        index = copy;
    }
    if (from.size() > vertices) gatherVertices(mesh, from);
    return {std::move(from), std::move(mirrored)};
}

float angleAt(const Mesh& mesh, const uint32_t* corner, size_t c) {
    const vec3& apex = mesh.positions[corner[c]];
    const vec3 a = safeNormalize(mesh.positions[corner[(c + 1) % 3]] - apex);
    const vec3 b = safeNormalize(mesh.positions[corner[(c + 2) % 3]] - apex);
    return std::acos(glm::clamp(glm::dot(a, b), -1.0f, 1.0f));
}

std::vector<vec3> sumTangents(const Mesh& mesh, const std::vector<Face>& faces) {
    std::vector<vec3> sums(mesh.positions.size(), vec3(0.0f));
    for (size_t f = 0; f < faces.size(); ++f) {
        if (faces[f].alongU == vec3(0.0f)) continue;
        const uint32_t* corner = &mesh.indices[3 * f];
        for (size_t c = 0; c < 3; ++c) {
            const vec3& normal = mesh.normals[corner[c]];
            const vec3 inPlane = faces[f].alongU - normal * glm::dot(normal, faces[f].alongU);
            sums[corner[c]] += safeNormalize(inPlane) * angleAt(mesh, corner, c);
        }
    }
    return sums;
}

/// Implements generateTangents() for the mesh at rest. Returns the old vertex that each new one copies, which
/// depends only on the indices and texture coordinates.
std::vector<uint32_t> generateStill(Mesh& mesh, int uvSet) {
    mesh.tangents.clear();
    std::vector<uint32_t> flat;
    if (mesh.normals.empty()) flat = addFlatNormals(mesh);
    const std::vector<vec2>& uv = uvSet == 1 ? mesh.uv1 : mesh.uv0;
    std::vector<Face> faces(mesh.triangleCount());
    for (size_t f = 0; f < faces.size() && !uv.empty(); ++f) faces[f] = faceTangent(mesh, uv, 3 * f);
    Split split = splitMirrored(mesh, faces);
    const std::vector<vec3> sums = sumTangents(mesh, faces);
    mesh.tangents.reserve(sums.size());
    for (size_t i = 0; i < sums.size(); ++i) {
        const vec3& normal = mesh.normals[i];
        vec3 tangent = safeNormalize(sums[i] - normal * glm::dot(normal, sums[i]));
        if (tangent == vec3(0.0f)) tangent = anyPerpendicular(normal);
        mesh.tangents.emplace_back(tangent, split.mirrored[i] ? -1.0f : 1.0f);
    }
    gather(flat, split.from);
    return flat.empty() ? std::move(split.from) : flat;
}

}  // namespace

void generateTangents(Mesh& mesh, int uvSet) {
    if (!mesh.deformation) {
        generateStill(mesh, uvSet);
        return;
    }
    // The deformation's vertices are split in the same way, and start from the normals and tangents at rest.
    Deformation deformation = *mesh.deformation;
    Mesh rest;
    rest.positions = std::move(deformation.positions);
    rest.normals = std::move(deformation.normals);
    rest.uv0 = mesh.uv0;
    rest.uv1 = mesh.uv1;
    rest.indices = mesh.indices;
    const std::vector<uint32_t> from = generateStill(rest, uvSet);
    generateStill(mesh, uvSet);
    deformation.positions = std::move(rest.positions);
    deformation.normals = std::move(rest.normals);
    deformation.tangents = std::move(rest.tangents);
    for (MorphTarget& target : deformation.targets) {
        gather(target.positions, from);
        gather(target.normals, from);
        target.tangents.clear();  // would belong to tangents that the file does not have
    }
    gather(deformation.joints, from);
    gather(deformation.weights, from);
    mesh.deformation = std::make_shared<const Deformation>(std::move(deformation));
}

}  // namespace limpid::scene
