// The steps of buildSceneData(), a file each.
#pragma once

#include <bit>

#include "scene/device/bvh.h"
#include "scene/device/scene_data.h"
#include "scene/model/scene.h"

namespace limpid::scene {

/// Trees, shading triangles, vertices and instances; needs features.vertexData.
void packGeometry(const Scene& scene, SceneData& data);
/// What poses the vertices of a deforming instance: appends to the motion data's rest vertices and morph
/// deltas.
DeformingInstance packDeformation(const Scene& scene, uint32_t instance, uint32_t firstVertex,
                                  MotionData& motion);
/// In which order the nodes of the deforming trees are refitted.
void findRefitLevels(SceneData& data);
/// Materials, texture references and mip levels; sets the features that follow from materials.
void packMaterials(const Scene& scene, SceneData& data);
/// Light list, its alias table, and the environment; needs the geometry's instances.
void packLights(const Scene& scene, SceneData& data);
/// The first two of these; needs the geometry's instances and sphere alone.
void packLamps(const Scene& scene, SceneData& data);
/// How shaders multiply and turn the environment, and how often they ask it; after packLamps().
void setEnvironmentParams(const Environment& env, layout::SceneParams& params);
/// Directional albedo of GGX reflection, and how metals spread what several facets scatter.
void fillGgxTable(std::vector<vec4>& table);
/// What several facets of a rough dielectric boundary reflect and transmit.
void fillDielectricTable(std::vector<vec4>& table);

/// Two snorm16 (Z. H. Cigolle et al., "A survey of efficient representations for independent unit vectors",
/// JCGT 2014).
uint32_t packDirection(const vec3& direction);

/// Invisible if it cannot be inverted, as in our own trees.
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
