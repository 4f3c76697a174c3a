// Data about the moving parts of a scene, built with the rest of SceneData and used by SceneAnimator for
// every frame.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "scene/device/lights/light_tree.h"
#include "scene/device/trees/bvh.h"

namespace limpid::scene {

/// A moving instance, as a leaf of the tree of moving instances.
struct MovingLeaf {
    uint32_t instance = 0;
    uint32_t record = 0;  ///< index into bvhInstances
    uint32_t root = 0;    ///< root node of its tree
    uint32_t tree = 0;    ///< index into SceneData::trees
    Aabb bounds;          ///< of that tree, in the instance's space; for deforming instances at rest
};

/// An instance whose vertices are deformed. Their vertices come first in the scene, so that a vertex's index
/// is also its index in the buffers of posed vertices.
struct DeformingInstance {
    uint32_t instance = 0;
    uint32_t leaf = 0;  ///< index into MotionData::leaves
    uint32_t firstVertex = 0, vertexCount = 0;
    uint32_t morphFirstTexel = 0, targetCount = 0;
    uint32_t jointCount = 0;  ///< 0: no skin
    std::vector<std::pair<uint32_t, Aabb>>
        jointBounds;                 ///< bounds of the rest positions of the vertices that each joint moves
    std::vector<Aabb> targetBounds;  ///< bounds of the position offsets of each morph target
};

/// The emissive triangles of a moving instance: consecutive in `lights`.
struct MovingLights {
    uint32_t instance = 0;
    uint32_t firstLight = 0;
    uint32_t firstDensity = 0;         ///< index of its table in lightDensity
    std::vector<uint32_t> triangles;   ///< indices in the mesh, in the order of the lights
    std::vector<float> probabilities;  ///< of choosing each by power, whatever its current size
    std::vector<float> radiances;      ///< mean strengths (light_bounds.h)
};

/// Nodes that can be refitted in parallel: their children are in earlier levels.
struct RefitLevel {
    uint32_t first = 0, count = 0;  ///< range in MotionData::refitNodes
};

struct NodeRange {
    uint32_t first = 0, count = 0;  ///< range in bvhNodes
};

struct MotionData {
    bool moving = false;
    std::vector<MovingLeaf> leaves;
    uint32_t firstTopNode = 0;  ///< a node that joins static and moving instances, followed by the tree of
                                ///< moving ones
    uint32_t topStack = 0;      ///< maximum number of stack entries of the moving tree
    uint32_t stillRoot = 0;
    Aabb stillBounds;  ///< empty: nothing is static

    std::vector<DeformingInstance> deforming;
    std::vector<uvec4> restVertices;  ///< layout::REST_VERTEX_TEXELS each
    std::vector<vec4> morphDeltas;    ///< layout::MORPH_DELTA_TEXELS per target and vertex
    std::vector<uint32_t> refitNodes;
    std::vector<RefitLevel> refitLevels;              ///< from the leaves up
    uint32_t firstRefitNode = 0, refitNodeCount = 0;  ///< nodes of deforming trees in bvhNodes

    std::vector<MovingLights> lights;
    LightTree lightTree;  ///< over all lights; empty if no light moves
};

}  // namespace limpid::scene
