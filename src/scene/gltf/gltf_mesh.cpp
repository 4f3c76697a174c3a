#include "scene/gltf/gltf_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "scene/gltf/document/gltf_access.h"
#include "scene/gltf/document/primitive_mode.h"
#include "scene/model/transform.h"
#include "scene/prepare/mesh_repair.h"

namespace limpid::scene::gltf {
namespace {

/// Returns three vertices per triangle from a list, a strip or a fan (glTF 2.0, section 3.7.2.1).
std::vector<uint32_t> toTriangles(std::vector<uint32_t> order, uint64_t mode) {
    if (mode == Triangles) {
        order.resize(order.size() / 3 * 3);
        return order;
    }
    std::vector<uint32_t> triangles;
    for (size_t i = 0; i + 2 < order.size(); ++i) {
        const size_t odd = i % 2;
        if (mode == TriangleStrip) {
            triangles.insert(triangles.end(), {order[i], order[i + 1 + odd], order[i + 2 - odd]});
        } else {
            triangles.insert(triangles.end(), {order[i + 1], order[i + 2], order[0]});
        }
    }
    return triangles;
}

template <typename Vector>
void requireLength(const Object& attributes, const char* name, const std::vector<Vector>& values,
                   size_t vertices) {
    if (values.empty() || values.size() == vertices) return;
    attributes.fail(name, fmt::format("has {} elements, but POSITION has {}", values.size(), vertices));
}

void requireFinitePositions(const Object& primitive, const Mesh& mesh) {
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        if (!isFinite(mesh.positions[i]))
            primitive.fail(fmt::format("the position of vertex {} is not finite", i));
    }
}

}  // namespace

/// A primitive's parts, as accessor indices.
struct MeshLibrary::Source {
    int position, normal, tangent, uv0, uv1, color, indices;
    uint64_t mode;
    std::vector<int64_t> key;
};

MeshLibrary::Source MeshLibrary::readSource(const Object& primitive) const {
    const size_t accessors = document_.lists().accessors.size();
    const auto attributes = primitive.object("attributes");
    if (!attributes) primitive.fail("has no attributes");
    Source source{};
    source.position = attributes->index("POSITION", accessors);
    source.normal = attributes->index("NORMAL", accessors);
    source.tangent = attributes->index("TANGENT", accessors);
    source.uv0 = attributes->index("TEXCOORD_0", accessors);
    source.uv1 = attributes->index("TEXCOORD_1", accessors);
    source.color = attributes->index("COLOR_0", accessors);
    source.indices = primitive.index("indices", accessors);
    source.mode = primitive.whole("mode", Triangles);
    if (source.mode > TriangleFan)
        primitive.fail("mode", fmt::format("is {}, which is none of glTF's", source.mode));
    source.key = {source.position, source.normal, source.tangent, source.uv0,
                  source.uv1,      source.color,  source.indices, static_cast<int64_t>(source.mode)};
    return source;
}

/// Adds the pose to the key. Primitives with the same key have the same vertices.
static void addPose(const Document& document, const Object& primitive, const Pose& pose,
                    std::vector<int64_t>& key) {
    const size_t accessors = document.lists().accessors.size();
    const size_t targets = std::min(primitive.listSize("targets"), pose.weights.size());
    for (size_t t = 0; t < targets; ++t) {
        if (pose.weights[t] == 0.0f) continue;
        key.push_back(std::bit_cast<uint32_t>(pose.weights[t]));
        const Object target = primitive.objectAt("targets", t);
        for (const char* name : {"POSITION", "NORMAL", "TANGENT"})
            key.push_back(target.index(name, accessors));
    }
    if (!pose.joints) return;
    const auto attributes = primitive.object("attributes");
    key.insert(key.end(), {int64_t{-2}, pose.skin, attributes->index("JOINTS_0", accessors),
                           attributes->index("WEIGHTS_0", accessors)});
}

int MeshLibrary::add(const Object& primitive, const std::string& name, const Pose& pose) {
    Source source = readSource(primitive);
    if (source.mode < Triangles) {
        document_.warn("points and lines are not drawn");
        return none;
    }
    if (source.position == none) {
        document_.warn(primitive.place() + " has no POSITION and is not drawn");
        return none;
    }
    addPose(document_, primitive, pose, source.key);
    const auto [entry, isNew] = known_.try_emplace(source.key, none);
    if (isNew) entry->second = build(primitive, source, name, pose);
    return entry->second;
}

void MeshLibrary::spend(const Object& blamed, uint64_t vertices, uint64_t triangles) {
    vertices_ += vertices;
    triangles_ += triangles;
    if (vertices_ > maxVertices || triangles_ > maxTriangles) {
        blamed.fail(fmt::format("with it the scene has more than {} vertices or triangles", maxVertices));
    }
}

void MeshLibrary::setAttributes(const Object& primitive, const Source& source, Mesh& mesh) const {
    mesh.positions = readVec3(document_, source.position);
    if (source.normal != none) mesh.normals = readVec3(document_, source.normal);
    if (source.tangent != none) mesh.tangents = readVec4(document_, source.tangent);
    if (source.uv0 != none) mesh.uv0 = readVec2(document_, source.uv0);
    if (source.uv1 != none) mesh.uv1 = readVec2(document_, source.uv1);
    if (source.color != none) mesh.colors = readColors(document_, source.color);

    const Object attributes = *primitive.object("attributes");
    const size_t vertices = mesh.positions.size();
    requireLength(attributes, "NORMAL", mesh.normals, vertices);
    requireLength(attributes, "TANGENT", mesh.tangents, vertices);
    requireLength(attributes, "TEXCOORD_0", mesh.uv0, vertices);
    requireLength(attributes, "TEXCOORD_1", mesh.uv1, vertices);
    requireLength(attributes, "COLOR_0", mesh.colors, vertices);
}

void MeshLibrary::setIndices(const Object& primitive, const Source& source, Mesh& mesh) const {
    const size_t vertices = mesh.positions.size();
    std::vector<uint32_t> order;
    if (source.indices != none) {
        order = readIndices(document_, source.indices);
    } else {
        order.resize(vertices);
        std::iota(order.begin(), order.end(), 0u);
    }
    for (const uint32_t index : order) {
        if (index >= vertices)
            primitive.fail("indices", fmt::format("names vertex {} of {}", index, vertices));
    }
    if (source.mode == Triangles && order.size() % 3 != 0) {
        document_.warn(primitive.place() + " ends with an incomplete triangle");
    }
    mesh.indices = toTriangles(std::move(order), source.mode);
}

int MeshLibrary::build(const Object& primitive, const Source& source, const std::string& name,
                       const Pose& pose) {
    const uint64_t vertices = accessorCount(document_, source.position);
    const uint64_t corners = source.indices == none ? vertices : accessorCount(document_, source.indices);
    spend(primitive, vertices, source.mode == Triangles ? corners / 3 : corners);
    Mesh mesh;
    mesh.name = name;
    setAttributes(primitive, source, mesh);
    setIndices(primitive, source, mesh);
    if (mesh.indices.empty()) return none;

    requireFinitePositions(primitive, mesh);
    const Repairs repairs = repairAttributes(mesh);
    if (repairs.any()) document_.warn(primitive.place() + ": " + repairs.describe());
    if (pose.joints || primitive.listSize("targets") > 0) applyPose(primitive, pose, mesh);
    scene_.meshes.push_back(std::move(mesh));
    return static_cast<int>(scene_.meshes.size() - 1);
}

void MeshLibrary::applyPose(const Object& primitive, const Pose& pose, Mesh& mesh) {
    spend(primitive, mesh.positions.size() * primitive.listSize("targets"), 0);
    auto deformation = std::make_shared<const Deformation>(readDeformation(document_, primitive, pose, mesh));
    DeformedVertices posed =
        deform(*deformation, pose.weights,
               pose.joints ? std::span<const mat4>(*pose.joints) : std::span<const mat4>());
    mesh.positions = std::move(posed.positions);
    mesh.normals = std::move(posed.normals);
    mesh.tangents = std::move(posed.tangents);
    requireFinitePositions(primitive, mesh);
    repairAttributes(mesh);
    if (!document_.lists().animations.empty()) mesh.deformation = std::move(deformation);
}

int MeshLibrary::flatten(const Object& node, int mesh, const mat4& transform) {
    const Mesh& source = scene_.meshes[static_cast<size_t>(mesh)];
    spend(node, source.positions.size(), source.triangleCount());
    Mesh flat = source;
    flat.normals.clear();
    flat.tangents.clear();
    flat.deformation.reset();
    for (vec3& position : flat.positions) position = transformPoint(transform, position);
    requireFinitePositions(node, flat);
    scene_.meshes.push_back(std::move(flat));
    return static_cast<int>(scene_.meshes.size() - 1);
}

}  // namespace limpid::scene::gltf
