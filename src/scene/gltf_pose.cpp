#include "scene/gltf_pose.h"

#include <fmt/format.h>

#include "scene/gltf_access.h"

namespace limpid::scene::gltf {
namespace {

/// Adds weight * delta to the first three components of each value.
template <typename Vector>
void addDeltas(const Document& document, const Object& target, const char* name, float weight,
               std::vector<Vector>& values) {
    const int accessor = target.index(name, document.lists().accessors.size());
    if (accessor == none || values.empty()) return;
    const std::vector<vec3> deltas = readVec3(document, accessor);
    if (deltas.size() != values.size()) {
        target.fail(
            name, fmt::format("has {} elements, but the mesh has {} vertices", deltas.size(), values.size()));
    }
    for (size_t i = 0; i < values.size(); ++i) {
        for (int c = 0; c < 3; ++c) values[i][c] += weight * deltas[i][c];
    }
}

/// The inverse transpose up to a positive or negative factor; defined for singular matrices too.
mat3 cofactors(const mat3& m) {
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

mat4 blend(const std::vector<mat4>& joints, const uvec4& joint, const vec4& weight, float sum) {
    // Weights should sum to 1; dividing by the sum also covers files that spread them over JOINTS_1.
    mat4 blended(0.0f);
    for (int c = 0; c < 4; ++c) blended += joints[joint[c]] * (weight[c] / sum);
    return blended;
}

}  // namespace

void applyMorphTargets(const Document& document, const Object& primitive, const std::vector<float>& weights,
                       Mesh& mesh) {
    const std::vector<Object> targets = primitive.objects("targets");
    for (size_t t = 0; t < targets.size() && t < weights.size(); ++t) {
        if (weights[t] == 0.0f) continue;
        addDeltas(document, targets[t], "POSITION", weights[t], mesh.positions);
        addDeltas(document, targets[t], "NORMAL", weights[t], mesh.normals);
        addDeltas(document, targets[t], "TANGENT", weights[t], mesh.tangents);
    }
}

void applySkin(const Document& document, const Object& primitive, const std::vector<mat4>& joints,
               Mesh& mesh) {
    const auto attributes = primitive.object("attributes");
    const size_t accessors = document.lists().accessors.size();
    const int jointAccessor = attributes->index("JOINTS_0", accessors);
    const int weightAccessor = attributes->index("WEIGHTS_0", accessors);
    if (jointAccessor == none || weightAccessor == none)
        attributes->fail("a skinned mesh needs JOINTS_0 and WEIGHTS_0");
    const std::vector<uvec4> jointOf = readJoints(document, jointAccessor);
    const std::vector<vec4> weightOf = readVec4(document, weightAccessor);
    if (jointOf.size() != mesh.positions.size() || weightOf.size() != mesh.positions.size()) {
        attributes->fail("JOINTS_0 and WEIGHTS_0 do not have one element per vertex");
    }
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        const float sum = weightOf[i].x + weightOf[i].y + weightOf[i].z + weightOf[i].w;
        for (int c = 0; c < 4; ++c) {
            if (jointOf[i][c] >= joints.size()) {
                attributes->fail("JOINTS_0",
                                 fmt::format("names joint {} of {}", jointOf[i][c], joints.size()));
            }
        }
        if (!(sum > 0.0f)) continue;  // a vertex that no joint moves stays where it is
        const mat4 toWorld = blend(joints, jointOf[i], weightOf[i], sum);
        mesh.positions[i] = vec3(toWorld * vec4(mesh.positions[i], 1.0f));
        if (!mesh.normals.empty()) mesh.normals[i] = cofactors(mat3(toWorld)) * mesh.normals[i];
        if (!mesh.tangents.empty()) {
            mesh.tangents[i] = vec4(mat3(toWorld) * vec3(mesh.tangents[i]), mesh.tangents[i].w);
        }
    }
}

}  // namespace limpid::scene::gltf
