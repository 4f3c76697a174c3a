// What a frame needs to know of the parts that move; made with the rest of SceneData, used by SceneAnimator.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "scene/device/bvh.h"

namespace limpid::scene {

/// A moving instance as a leaf of the tree over moving things.
struct MovingLeaf {
    uint32_t instance = 0;
    uint32_t record = 0;  ///< in bvhInstances
    uint32_t root = 0;    ///< of its tree
    uint32_t tree = 0;    ///< in SceneData::trees
    Aabb bounds;          ///< of that tree, in the instance's space; of deforming ones at rest
};

/// An instance whose vertices move. They are the scene's first, so that a vertex' number is its place in the
/// buffers of posed vertices.
struct DeformingInstance {
    uint32_t instance = 0;
    uint32_t leaf = 0;  ///< in MotionData::leaves
    uint32_t firstVertex = 0, vertexCount = 0;
    uint32_t morphFirstTexel = 0, targetCount = 0;
    uint32_t jointCount = 0;  ///< 0: no skin
    std::vector<std::pair<uint32_t, Aabb>>
        jointBounds;                 ///< rest positions of the vertices that a joint moves
    std::vector<Aabb> targetBounds;  ///< of the position deltas of each morph target
};

/// Emissive triangles of a moving instance: consecutive in `lights`.
struct MovingLights {
    uint32_t instance = 0;
    uint32_t firstLight = 0;
    uint32_t firstDensity = 0;         ///< its table in lightDensity
    std::vector<uint32_t> triangles;   ///< of the mesh, in the order of the lights
    std::vector<float> probabilities;  ///< of choosing each, whatever its size now
};

/// Nodes that can be refitted at once: their children are in earlier levels.
struct RefitLevel {
    uint32_t first = 0, count = 0;  ///< in MotionData::refitNodes
};

struct NodeRange {
    uint32_t first = 0, count = 0;  ///< in bvhNodes
};

struct MotionData {
    bool moving = false;
    std::vector<MovingLeaf> leaves;
    uint32_t firstTopNode =
        0;                  ///< a node that joins still and moving things, then the tree of the moving ones
    uint32_t topStack = 0;  ///< entries that the moving tree may need
    uint32_t stillRoot = 0;
    Aabb stillBounds;  ///< empty: nothing stays still

    std::vector<DeformingInstance> deforming;
    std::vector<uvec4> restVertices;  ///< layout::REST_VERTEX_TEXELS each
    std::vector<vec4> morphDeltas;    ///< layout::MORPH_DELTA_TEXELS per target and vertex
    std::vector<uint32_t> refitNodes;
    std::vector<RefitLevel> refitLevels;              ///< from the leaves up
    uint32_t firstRefitNode = 0, refitNodeCount = 0;  ///< nodes of deforming trees in bvhNodes

    std::vector<MovingLights> lights;
};

}  // namespace limpid::scene
