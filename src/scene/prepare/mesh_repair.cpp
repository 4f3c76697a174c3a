#include "scene/prepare/mesh_repair.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace limpid::scene {
namespace {

void repairNormals(Mesh& mesh, Repairs& repairs) {
    std::vector<vec3> faceNormals;
    for (size_t i = 0; i < mesh.normals.size(); ++i) {
        vec3& normal = mesh.normals[i];
        const vec3 unit = safeNormalize(normal);
        if (unit != vec3(0.0f)) {
            if (std::abs(glm::length(normal) - 1.0f) > 0.01f) ++repairs.rescaledNormals;
            normal = unit;
            continue;
        }
        if (faceNormals.empty()) faceNormals = sumFaceNormals(mesh);
        normal = safeNormalize(faceNormals[i]);
        if (normal == vec3(0.0f)) normal = {0.0f, 1.0f, 0.0f};
        ++repairs.recomputedNormals;
    }
}

void repairTangents(Mesh& mesh, Repairs& repairs) {
    // Tangents without normals are meaningless (glTF says: ignore them).
    if (mesh.normals.empty()) mesh.tangents.clear();
    for (size_t i = 0; i < mesh.tangents.size(); ++i) {
        const vec3& normal = mesh.normals[i];
        const vec3 given = safeNormalize(vec3(mesh.tangents[i]));
        vec3 tangent = safeNormalize(given - normal * glm::dot(normal, given));
        if (tangent == vec3(0.0f)) {
            tangent = anyPerpendicular(normal);
            ++repairs.replacedTangents;
        }
        mesh.tangents[i] = vec4(tangent, mesh.tangents[i].w < 0.0f ? -1.0f : 1.0f);
    }
}

template <typename Vector>
void repairValues(std::vector<Vector>& values, Repairs& repairs) {
    for (Vector& value : values) {
        if (isFinite(value)) continue;
        value = Vector(0.0f);
        ++repairs.zeroedValues;
    }
}

}  // namespace

bool isFinite(const vec2& v) {
    return std::isfinite(v.x) && std::isfinite(v.y);
}
bool isFinite(const vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool isFinite(const vec4& v) {
    return isFinite(vec3(v)) && std::isfinite(v.w);
}

vec3 safeNormalize(const vec3& v) {
    const vec3 size = glm::abs(v);
    const float largest = std::max(size.x, std::max(size.y, size.z));
    if (!isFinite(v) || !(largest > 0.0f)) return vec3(0.0f);
    const vec3 scaled = v / largest;
    // Dividing by a denormal can still overflow.
    return isFinite(scaled) ? glm::normalize(scaled) : vec3(0.0f);
}

vec3 anyPerpendicular(const vec3& n) {
    const vec3 axis = std::abs(n.x) < 0.7f ? vec3(1, 0, 0) : vec3(0, 1, 0);
    return glm::normalize(glm::cross(n, axis));
}

std::vector<vec3> sumFaceNormals(const Mesh& mesh) {
    std::vector<vec3> sums(mesh.positions.size(), vec3(0.0f));
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const uint32_t corners[3] = {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
        const vec3& origin = mesh.positions[corners[0]];
        const vec3 normal =
            glm::cross(mesh.positions[corners[1]] - origin, mesh.positions[corners[2]] - origin);
        if (!isFinite(normal)) continue;
        for (const uint32_t corner : corners) sums[corner] += normal;
    }
    return sums;
}

Repairs repairAttributes(Mesh& mesh) {
    Repairs repairs;
    repairNormals(mesh, repairs);
    repairTangents(mesh, repairs);
    repairValues(mesh.uv0, repairs);
    repairValues(mesh.uv1, repairs);
    repairValues(mesh.colors, repairs);
    for (vec4& color : mesh.colors) color = glm::max(color, vec4(0.0f));
    return repairs;
}

std::string Repairs::describe() const {
    std::vector<std::string> parts;
    if (rescaledNormals) parts.push_back(fmt::format("{} normals not of unit length", rescaledNormals));
    if (recomputedNormals)
        parts.push_back(fmt::format("{} normals recomputed from faces", recomputedNormals));
    if (replacedTangents) parts.push_back(fmt::format("{} unusable tangents replaced", replacedTangents));
    if (zeroedValues)
        parts.push_back(fmt::format("{} texture coordinates or colours not finite", zeroedValues));
    return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace limpid::scene
