#include "scene/gltf/rig/gltf_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/gltf/document/gltf_access.h"
#include "scene/prepare/mesh_repair.h"

namespace limpid::scene::gltf {
namespace {

/// Maximum deviation from 1 of the sum of a vertex's weights without a warning.
constexpr float weightTolerance = 1e-2f;

std::vector<vec3> readDeltas(const Document& document, const Object& target, const char* name,
                             size_t vertices) {
    const int accessor = target.index(name, document.lists().accessors.size());
    if (accessor == none || vertices == 0) return {};
    std::vector<vec3> deltas = readVec3(document, accessor);
    if (deltas.size() != vertices) {
        target.fail(name,
                    fmt::format("has {} elements, but the mesh has {} vertices", deltas.size(), vertices));
    }
    if (!std::all_of(deltas.begin(), deltas.end(), [](const vec3& d) { return isFinite(d); }))
        target.fail(name, "has a value that is not finite");
    return deltas;
}

/// Normalises every vertex's weights to a sum of 1.
void normaliseWeights(Document& document, const Object& primitive, std::vector<vec4>& weights) {
    size_t odd = 0;
    for (vec4& weight : weights) {
        const bool negative = glm::any(glm::lessThan(weight, vec4(0.0f)));
        weight = glm::max(weight, vec4(0.0f));
        const float sum = weight.x + weight.y + weight.z + weight.w;
        const bool usable = isFinite(weight) && sum > 1e-20f && std::isfinite(sum);
        if (negative || !usable || std::abs(sum - 1.0f) > weightTolerance) ++odd;
        // Dividing by the sum also handles files that use WEIGHTS_1 too.
        weight = usable ? weight / sum : vec4(0.0f);
    }
    if (odd > 0) {
        document.warn(
            fmt::format("{}: the weights of {} vertices are negative or do not sum to 1 and were corrected",
                        primitive.place(), odd));
    }
}

void readInfluences(Document& document, const Object& primitive, const Pose& pose, Deformation& deformation) {
    const auto attributes = primitive.object("attributes");
    const size_t accessors = document.lists().accessors.size();
    const int jointAccessor = attributes->index("JOINTS_0", accessors);
    const int weightAccessor = attributes->index("WEIGHTS_0", accessors);
    if (jointAccessor == none || weightAccessor == none)
        attributes->fail("a skinned mesh needs JOINTS_0 and WEIGHTS_0");
    const std::vector<uvec4> joints = readJoints(document, jointAccessor);
    deformation.weights = readVec4(document, weightAccessor);
    const size_t vertices = deformation.positions.size();
    if (joints.size() != vertices || deformation.weights.size() != vertices)
        attributes->fail("JOINTS_0 and WEIGHTS_0 do not have one element per vertex");
    deformation.joints.resize(vertices);
    for (size_t i = 0; i < vertices; ++i) {
        for (int c = 0; c < 4; ++c) {
            if (joints[i][c] >= pose.joints->size()) {
                attributes->fail("JOINTS_0",
                                 fmt::format("names joint {} of {}", joints[i][c], pose.joints->size()));
            }
            deformation.joints[i][static_cast<size_t>(c)] = static_cast<uint16_t>(joints[i][c]);
        }
    }
    if (attributes->has("JOINTS_1"))
        document.warn(primitive.place() + ": more than four joints a vertex; the first four are used");
    normaliseWeights(document, primitive, deformation.weights);
}

}  // namespace

Skin readSkin(const Document& document, const Object& source) {
    constexpr size_t maxJoints = 65536;
    Skin skin;
    skin.joints = source.indices("joints", document.lists().nodes.size());
    if (skin.joints.empty()) source.fail("joints", "is empty");
    if (skin.joints.size() > maxJoints) source.fail("joints", "has too many");
    const int accessor = source.index("inverseBindMatrices", document.lists().accessors.size());
    if (accessor == none) {
        skin.inverseBind.assign(skin.joints.size(), mat4(1.0f));
        return skin;
    }
    const uint64_t count = accessorCount(document, accessor);
    if (count < skin.joints.size()) {
        source.fail("inverseBindMatrices",
                    fmt::format("has {} matrices for {} joints", count, skin.joints.size()));
    }
    // There may be more, and many skins may name the same large accessor.
    skin.inverseBind = readMat4(document, accessor, skin.joints.size());
    for (const mat4& m : skin.inverseBind) {
        if (!isFinite(m[0]) || !isFinite(m[1]) || !isFinite(m[2]) || !isFinite(m[3]))
            source.fail("inverseBindMatrices", "has a value that is not finite");
    }
    return skin;
}

Deformation readDeformation(Document& document, const Object& primitive, const Pose& pose, const Mesh& mesh) {
    Deformation deformation{mesh.positions, mesh.normals, mesh.tangents, {}, {}, {}};
    for (const Object& source : primitive.objects("targets")) {
        MorphTarget& target = deformation.targets.emplace_back();
        target.positions = readDeltas(document, source, "POSITION", mesh.positions.size());
        target.normals = readDeltas(document, source, "NORMAL", mesh.normals.size());
        target.tangents = readDeltas(document, source, "TANGENT", mesh.tangents.size());
    }
    if (pose.joints) readInfluences(document, primitive, pose, deformation);
    return deformation;
}

}  // namespace limpid::scene::gltf
