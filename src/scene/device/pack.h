// The steps of buildSceneData(), each in a file of its own.
#pragma once

#include <array>
#include <bit>
#include <optional>

#include "scene/device/scene_data.h"
#include "scene/device/trees/bvh.h"
#include "scene/model/scene.h"

namespace limpid::scene {

/// Packs trees, shading triangles, vertices and instances. Needs features.vertexData.
void packGeometry(const Scene& scene, SceneData& data, const Progress& progress);
/// Packs the data that poses the vertices of a deforming instance: appends to the rest vertices and morph
/// deltas of the motion data.
DeformingInstance packDeformation(const Scene& scene, uint32_t instance, uint32_t firstVertex,
                                  MotionData& motion);
/// Determines the order in which the nodes of deforming trees are refitted.
void findRefitLevels(SceneData& data);
/// Where the textures of a scene and their mip levels lie.
struct TexturePlaces {
    struct Place {
        uint32_t buffer = 0, first = 0;  ///< of SceneData::texels
    };
    std::vector<std::optional<Place>> places;            ///< by texture; none: no material uses it
    std::array<uint64_t, layout::TEXEL_BUFFERS> used{};  ///< texels in each buffer
};
/// Packs materials and texture references, and sets the features that depend on materials. Throws Error if
/// the textures do not fit.
TexturePlaces packMaterials(const Scene& scene, SceneData& data);
/// Makes the mip levels of all textures.
void fillTexels(const TexturePlaces& places, const Scene& scene, SceneData& data, const Progress& progress);
/// Packs the light list, its tables, and the environment. Needs the geometry's instances.
void packLights(const Scene& scene, SceneData& data, std::optional<bool> hasTree = {});
/// Packs the light list and its tables only. Needs only the geometry's instances and bounding sphere.
/// `hasTree`: whether there is a light tree; without a value, what the lights need. Scenes whose lights
/// change keep what they were loaded with.
void packLamps(const Scene& scene, SceneData& data, std::optional<bool> hasTree = {});
/// Sets the environment's factor, rotation and sampling probability for shaders. Call it after packLamps().
void setEnvironmentParams(const Environment& env, layout::SceneParams& params);
/// Fills the table with the directional albedo of GGX reflection, and how metals distribute multiple
/// scattering.
void fillGgxTable(std::vector<vec4>& table);
/// Appends the albedo of the sheen's lobe to the table that fillGgxTable() has filled.
void fillSheenTable(std::vector<vec4>& table);
/// Fills the table with the multiple scattering of a rough dielectric boundary: reflection and transmission.
void fillDielectricTable(std::vector<vec4>& table);

/// Returns a triangle's area. Lengths far from 1 neither overflow nor underflow on the way.
double triangleArea(const std::array<vec3, 3>& corners);

/// Returns the magnitude in the record of a triangle light (scene_layout.h).
/// @param own    corners in the mesh's coordinates
/// @param world  the same in the world
uint32_t packMagnitude(const mat4& toWorld, const std::array<vec3, 3>& own, const std::array<vec3, 3>& world);

/// Packs a unit vector as two snorm16 (Z. H. Cigolle et al., "A survey of efficient representations for
/// independent unit vectors", JCGT 2014).
uint32_t packDirection(const vec3& direction);

/// Returns a placement that is invisible if the matrix cannot be inverted, as in our own trees.
gpu::TreePlacement placementOf(uint32_t tree, const mat4& toWorld);

inline uint32_t bits(float value) {
    return std::bit_cast<uint32_t>(value);
}
inline uvec4 bits(const vec3& v, uint32_t w) {
    return {bits(v.x), bits(v.y), bits(v.z), w};
}
inline uvec4 bits(const vec3& v, float w) {
    return bits(v, bits(w));
}

}  // namespace limpid::scene
