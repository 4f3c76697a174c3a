#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <map>

#include "scene/device/pack.h"

namespace limpid::scene {
namespace {

vec2 octahedral(const vec3& direction) {
    const vec3 n = direction / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
    if (n.z >= 0.0f) return {n.x, n.y};
    const vec2 folded = 1.0f - glm::abs(vec2(n.y, n.x));
    return {n.x >= 0.0f ? folded.x : -folded.x, n.y >= 0.0f ? folded.y : -folded.y};
}

void packRestVertex(const Deformation& d, size_t v, std::vector<uvec4>& out) {
    const vec3 normal = d.normals.empty() ? vec3(0, 0, 1) : d.normals[v];
    const vec4 tangent = d.tangents.empty() ? vec4(1, 0, 0, 1) : d.tangents[v];
    uint32_t tangentBits = packDirection(vec3(tangent)) & ~1u;
    if (tangent.w < 0.0f) tangentBits |= 1u;
    std::array<uint16_t, 4> joints{};
    vec4 weights(0.0f);
    if (!d.joints.empty()) {
        joints = d.joints[v];
        weights = d.weights[v];
    }
    out.push_back(bits(d.positions[v], packDirection(normal)));
    out.emplace_back(tangentBits, uint32_t{joints[0]} | uint32_t{joints[1]} << 16,
                     uint32_t{joints[2]} | uint32_t{joints[3]} << 16, 0u);
    out.push_back(bits(vec3(weights), weights.w));
}

void packMorphTarget(const MorphTarget& target, size_t vertices, std::vector<vec4>& out) {
    const auto delta = [](const std::vector<vec3>& deltas, size_t v) {
        return vec4(deltas.empty() ? vec3(0.0f) : deltas[v], 0.0f);
    };
    for (size_t v = 0; v < vertices; ++v) {
        out.push_back(delta(target.positions, v));
        out.push_back(delta(target.normals, v));
        out.push_back(delta(target.tangents, v));
    }
}

/// Computes boxes from which the posed instance's box can be derived without reading vertices.
void findBounds(const Deformation& d, DeformingInstance& out) {
    for (const MorphTarget& target : d.targets) {
        Aabb box;
        box.grow(vec3(0.0f));
        for (const vec3& delta : target.positions) box.grow(delta);
        out.targetBounds.push_back(box);
    }
    std::map<uint32_t, Aabb> boxes;
    for (size_t v = 0; v < d.positions.size(); ++v) {
        if (d.joints.empty() || d.weights[v] == vec4(0.0f)) {
            boxes[layout::NONE].grow(d.positions[v]);
            continue;
        }
        for (int c = 0; c < 4; ++c) {
            if (d.weights[v][c] != 0.0f) boxes[d.joints[v][static_cast<size_t>(c)]].grow(d.positions[v]);
        }
    }
    out.jointBounds.assign(boxes.begin(), boxes.end());
}

/// Returns a node's height above the leaves.
uint32_t heightOf(const SceneData& data, uint32_t node, std::vector<uint32_t>& heights) {
    const uvec4* texels = &data.bvhNodes[size_t{node} * layout::BVH_NODE_TEXELS];
    uint32_t height = 0;
    for (int slot = 0; slot < 4; ++slot) {
        const uint32_t child = texels[3][slot];
        const bool isCopy = slot > 0 && child == texels[3][0];  // marks a missing child
        if (!BvhRef::isLeaf(child) && !isCopy) height = std::max(height, heightOf(data, child, heights) + 1);
    }
    heights[node - data.motion.firstRefitNode] = height;
    return height;
}

}  // namespace

uint32_t packDirection(const vec3& direction) {
    return glm::packSnorm2x16(octahedral(direction));
}

DeformingInstance packDeformation(const Scene& scene, uint32_t index, uint32_t firstVertex,
                                  MotionData& motion) {
    const Instance& instance = scene.instances[index];
    const Deformation& d = *scene.meshes[static_cast<size_t>(instance.mesh)].deformation;
    DeformingInstance out;
    out.instance = index;
    out.firstVertex = firstVertex;
    out.vertexCount = static_cast<uint32_t>(d.positions.size());
    out.targetCount = static_cast<uint32_t>(d.targets.size());
    out.morphFirstTexel = static_cast<uint32_t>(motion.morphDeltas.size());
    if (instance.skin != none) {
        out.jointCount =
            static_cast<uint32_t>(scene.rig.skins[static_cast<size_t>(instance.skin)].joints.size());
    }
    for (size_t v = 0; v < d.positions.size(); ++v) packRestVertex(d, v, motion.restVertices);
    for (const MorphTarget& target : d.targets)
        packMorphTarget(target, d.positions.size(), motion.morphDeltas);
    findBounds(d, out);
    return out;
}

void findRefitLevels(SceneData& data) {
    MotionData& motion = data.motion;
    std::vector<uint32_t> heights(motion.refitNodeCount, 0);
    for (const DeformingInstance& deforming : motion.deforming)
        heightOf(data, motion.leaves[deforming.leaf].root, heights);
    const uint32_t top = heights.empty() ? 0 : *std::max_element(heights.begin(), heights.end());
    for (uint32_t level = 0; level <= top && !heights.empty(); ++level) {
        const auto first = static_cast<uint32_t>(motion.refitNodes.size());
        for (uint32_t i = 0; i < heights.size(); ++i) {
            if (heights[i] == level) motion.refitNodes.push_back(motion.firstRefitNode + i);
        }
        motion.refitLevels.push_back({first, static_cast<uint32_t>(motion.refitNodes.size()) - first});
    }
}

}  // namespace limpid::scene
