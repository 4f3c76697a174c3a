#include "scene/motion/deformation.h"

#include <algorithm>

#include "scene/model/transform.h"

namespace limpid::scene {
namespace {

template <typename Vector>
void addDeltas(const std::vector<vec3>& deltas, float weight, std::vector<Vector>& values) {
    if (deltas.empty()) return;
    for (size_t i = 0; i < values.size(); ++i) {
        for (int c = 0; c < 3; ++c) values[i][c] += weight * deltas[i][c];
    }
}

/// The inverse transpose up to a factor; also defined for singular matrices.
mat3 cofactors(const mat3& m) {
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

}  // namespace

DeformedVertices deform(const Deformation& deformation, std::span<const float> morphWeights,
                        std::span<const mat4> joints) {
    DeformedVertices out{deformation.positions, deformation.normals, deformation.tangents};
    const size_t targets = std::min(deformation.targets.size(), morphWeights.size());
    for (size_t t = 0; t < targets; ++t) {
        const MorphTarget& target = deformation.targets[t];
        if (morphWeights[t] == 0.0f) continue;
        addDeltas(target.positions, morphWeights[t], out.positions);
        addDeltas(target.normals, morphWeights[t], out.normals);
        addDeltas(target.tangents, morphWeights[t], out.tangents);
    }
    if (joints.empty()) return out;
    for (size_t i = 0; i < deformation.joints.size(); ++i) {
        const vec4& weight = deformation.weights[i];
        if (weight == vec4(0.0f)) continue;
        mat4 blended(0.0f);
        for (int c = 0; c < 4; ++c)
            blended += joints[deformation.joints[i][static_cast<size_t>(c)]] * weight[c];
        out.positions[i] = transformPoint(blended, out.positions[i]);
        if (!out.normals.empty()) out.normals[i] = cofactors(mat3(blended)) * out.normals[i];
        if (!out.tangents.empty()) {
            out.tangents[i] = vec4(mat3(blended) * vec3(out.tangents[i]), out.tangents[i].w);
        }
    }
    return out;
}

}  // namespace limpid::scene
