// A scene in the format that shaders read (shaders/common/scene_layout.h), on the CPU, where tests can check
// it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "base/raw_vector.h"
#include "gpu/graph/resources.h"
#include "scene/model/scene.h"
#include "scene/motion/motion_data.h"
#include "shaders/common/scene_layout.h"

namespace limpid::scene {

/// The shader features that a scene needs; each member is a specialisation constant in scene_data.glsl.
struct SceneFeatures {
    bool twoLevel = false, vertexData = false, textures = false, alpha = false, specular = false,
         transmission = false, triangleLights = false, punctualLights = false, environment = false,
         mirrored = false, motion = false, clearcoat = false, volume = false, specularTextures = false,
         roughGlass = false, lightTree = false, suns = false, anisotropy = false, sheen = false,
         diffuseTransmission = false, dispersion = false, iridescence = false, lightDistances = false,
         panes = false, blended = false;
    bool operator==(const SceneFeatures&) const = default;
};

struct SceneData {
    RawVector<vec4> bvhTriangles;
    RawVector<uvec4> triangles, vertices;
    std::vector<uvec4> bvhNodes, bvhInstances, instances, previousGeometry, materials, textureRefs, lights,
        lightTree;
    std::vector<vec4> environment, environmentPyramid, lightPyramid, ggxTable, dielectricTable;
    std::vector<float> lightDensity;
    std::array<std::vector<uint32_t>, layout::TEXEL_BUFFERS> texels;
    SceneFeatures features;
    layout::SceneParams params{};
    uint32_t stackSize = 0;
    MotionData motion;
    /// For the `hardware` tracer: the trees as ranges of bvhTriangles, and a placement for each record of
    /// bvhInstances. A scene of one tree has one placement.
    std::vector<gpu::TriangleTree> trees;
    std::vector<gpu::TreePlacement> placements;
    /// Of bvhTriangles: those that stand elsewhere, too, since a tree has parts of them in several leaves.
    /// All but one of each.
    std::vector<uint32_t> repeatedTriangles;

    uint64_t byteCount() const;
};

/// Builds trees, light tables and mip levels. `hasLightTree`: see packLamps(). Throws Error if the textures
/// exceed 4 x 2^27 texels, and Cancelled as `progress` does.
SceneData buildSceneData(const Scene& scene, const Progress& progress = {},
                         std::optional<bool> hasLightTree = {});

}  // namespace limpid::scene
