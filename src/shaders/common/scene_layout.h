// The layout of the scene in storage texel buffers. Included by C++ (scene/scene_data.*) and GLSL
// (scene_data.glsl). A texel is 16 bytes unless stated otherwise; floats are stored as their bits.
#ifndef LIMPID_SHADERS_SCENE_LAYOUT_H
#define LIMPID_SHADERS_SCENE_LAYOUT_H

#ifdef __cplusplus
#include "base/math.h"
namespace limpid::layout {
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
#endif

LIMPID_CONST uint NONE = 0xFFFFFFFFu;

// bvhNodes, quantised (on CPUs): scene/device/trees/bvh.h's BvhNode.
LIMPID_CONST uint BVH_NODE_TEXELS = 4u;
// bvhNodes, expanded (on GPUs): x, y, z of the lower corners of the four children, then of the upper;
// children. A missing child has its lower corner above its upper.
LIMPID_CONST uint EXPANDED_NODE_TEXELS = 7u;

// bvhTriangles, in leaf order: v0 | primitive; v1 | instance or NONE (then the one being traversed); v2 |
// shading triangle. Positions are in world space in the static tree, in object space in an instanced one.
LIMPID_CONST uint BVH_TRIANGLE_TEXELS = 3u;
LIMPID_CONST uint BVH_TRIANGLE_ALPHA = 0x80000000u;  // in the first texel's w: candidates need the alpha test

// bvhInstances, leaves of the top-level tree: three rows of world-to-object; root node | instance | the
// tree's first triangle in bvhTriangles | 0.
LIMPID_CONST uint BVH_INSTANCE_TEXELS = 4u;

// triangles (shading): vertex 0, 1, 2 | material slot and flags.
LIMPID_CONST uint TRIANGLE_MATERIAL_MASK = 0x00FFFFFFu;
LIMPID_CONST uint TRIANGLE_SMOOTH = 0x80000000u;  // has vertex normals

// vertices: normal (octahedral 2 x snorm16) | tangent (octahedral, lowest bit: sign) | uv0; uv1 | colour (4 x
// unorm16).
LIMPID_CONST uint VERTEX_TEXELS = 2u;

// instances: three rows of object-to-world; material | first entry in lightDensity or NONE | first shading
// triangle | flags. lightDensity: one float for each primitive of an emissive instance: the probability that
// next-event estimation chooses it, divided by its area.
LIMPID_CONST uint INSTANCE_TEXELS = 4u;
LIMPID_CONST uint INSTANCE_MIRRORED = 1u;   // negative determinant: front faces are clockwise
LIMPID_CONST uint INSTANCE_DEFORMING = 2u;  // its vertices have their own previous positions
LIMPID_CONST uint INSTANCE_HAS_TREE = 4u;   // its triangles are in a tree in object space

// previousGeometry, only in moving scenes: for each instance three rows of object-to-world in the previous
// frame; then for each vertex of deforming instances its position in that instance's space | normal
// (octahedral).
LIMPID_CONST uint PREVIOUS_INSTANCE_TEXELS = 3u;

// restVertices, before morphing and skinning: position | normal (octahedral); tangent (octahedral, lowest
// bit: sign) | joints 0, 1 | joints 2, 3 | 0; weights.
LIMPID_CONST uint REST_VERTEX_TEXELS = 3u;
// morphDeltas: of position, normal, tangent; all vertices of a target, then the next target.
LIMPID_CONST uint MORPH_DELTA_TEXELS = 3u;
// poseMatrices: three rows per joint; then morph weights, four per texel.
LIMPID_CONST uint POSE_MATRIX_TEXELS = 3u;
// nodeBounds of deforming trees: lower corner; upper corner.
LIMPID_CONST uint NODE_BOUNDS_TEXELS = 2u;

// materials: baseColor rgb | flags; emission | roughness; metallic | specular | ior | transmission;
// alpha | cutoff | normal scale | 0; texture references (base, metallic-roughness, normal, emission);
// reference of transmission | specular colour; references (specular, specular colour, clear coat, its
// roughness); reference of its normal | clear coat | its roughness | its normal scale; absorption |
// dispersion; anisotropy | cos, sin of its rotation | reference of its texture; sheen colour | its roughness;
// references (sheen colour, its roughness, diffuse transmission, its colour); diffuse transmission's colour |
// its share; iridescence | the film's ior | its least | its greatest thickness; references (iridescence,
// thickness, none, none).
LIMPID_CONST uint MATERIAL_TEXELS = 15u;
LIMPID_CONST uint MATERIAL_MASK = 1u;
LIMPID_CONST uint MATERIAL_BLEND = 2u;
LIMPID_CONST uint MATERIAL_DOUBLE_SIDED = 4u;
LIMPID_CONST uint MATERIAL_UNLIT = 8u;
LIMPID_CONST uint MATERIAL_THIN = 16u;
LIMPID_CONST uint MATERIAL_EMISSIVE = 32u;

// textureRefs: rowU | texture's first texel (bits 27.. choose the texel buffer); rowV | sampler and flags;
// width | height | levels | 0.
LIMPID_CONST uint TEXTURE_REF_TEXELS = 3u;
LIMPID_CONST uint TEXEL_BUFFER_SHIFT = 27u;
LIMPID_CONST uint TEXEL_BUFFERS = 4u;
LIMPID_CONST uint TEXTURE_WRAP_U_SHIFT = 0u;  // 2 bits: scene::Wrap
LIMPID_CONST uint TEXTURE_WRAP_V_SHIFT = 2u;
LIMPID_CONST uint TEXTURE_MIP_SHIFT = 4u;  // 2 bits: scene::MipFilter
LIMPID_CONST uint TEXTURE_MAG_LINEAR = 64u;
LIMPID_CONST uint TEXTURE_MIN_LINEAR = 128u;
LIMPID_CONST uint TEXTURE_SRGB = 256u;
LIMPID_CONST uint TEXTURE_UV1 = 512u;

// lights: emissive triangles first, then punctual lights. Triangle: v0 | kind; v1 | probability; v2 | shading
// triangle; emission | material, or NONE if the emission has no texture and no clear coat. Punctual: position
// | kind; direction | 0; cos inner | cos outer | range | 0; intensity | 0. A triangle's kind also has the
// largest number that occurs while the triangle of an instance with a tree is placed in the world, as the
// upper bits of a float; 0 if none is larger than its coordinates there.
LIMPID_CONST uint LIGHT_TEXELS = 4u;
LIMPID_CONST uint LIGHT_TRIANGLE = 0u;
LIMPID_CONST uint LIGHT_TRIANGLE_TWO_SIDED = 1u;
LIMPID_CONST uint LIGHT_POINT = 2u;
LIMPID_CONST uint LIGHT_SPOT = 3u;
LIMPID_CONST uint LIGHT_DIRECTIONAL = 4u;
LIMPID_CONST uint LIGHT_KIND_MASK = 7u;
LIMPID_CONST uint LIGHT_MIRRORED =
    8u;  // v1 and v2 are swapped relative to the mesh, so that the front face stays the front
LIMPID_CONST uint LIGHT_MAGNITUDE_MASK = 0xFFFFFFF0u;

// lightTree: children of nodes (scene/device/lights/light_tree.h), the root's first, those of a node one
// after the other. A child: centre of the bounding sphere | its radius and the range, upper halves of floats;
// axis (octahedral) | sin of half the angles of the cone and of the ramp beyond it (2 x unorm16; a spot's:
// inner and outer cone) | intensity | link. Then a texel for each entry of lightDensity: trail from the root.
// Then a texel for each directional light: its index in `lights` | 0 | 0 | 0.
LIMPID_CONST uint LIGHT_CHILD_TEXELS = 2u;
LIMPID_CONST uint LIGHT_NODE_WIDTH = 4u;       // largest number of children
LIMPID_CONST uint LIGHT_ROOT_CHILDREN = 68u;   // the same for the root: also point and spot lights
LIMPID_CONST uint LIGHT_TRAIL_BITS = 2u;       // number of a child
LIMPID_CONST uint LIGHT_TRAIL_ROOT_BITS = 8u;  // the same for the root
LIMPID_CONST uint LIGHT_LINK_LEAF =
    0x80000000u;  // the link's index is that of a light, not of a node's first child
LIMPID_CONST uint LIGHT_LINK_TWO_SIDED = 0x40000000u;
LIMPID_CONST uint LIGHT_LINK_SPOT = 0x20000000u;
LIMPID_CONST uint LIGHT_LINK_LAST = 0x10000000u;  // the node's last child
LIMPID_CONST uint LIGHT_LINK_INDEX = 0x0FFFFFFFu;

// lightDistances (4-byte texels), only with several point and spot lights: an octahedral map of
// LIGHT_MAP_SIZE^2 texels for each of the first LIGHT_MAPS punctual lights. A texel has two distances, in
// world units, as upper halves of floats (passes/light_distances): beyond that of the lower 16 bits the light
// is probably hidden in these directions, beyond that of the upper 16 bits almost surely. Those of
// directional lights are infinite.
LIMPID_CONST uint LIGHT_MAP_SIZE = 32u;
LIMPID_CONST uint LIGHT_MAPS = 1024u;
LIMPID_CONST float LIGHT_MAP_NOT_HIDDEN = 1e30;  // equals INFINITE_DISTANCE

// environment: radiance | probability of choosing this texel.
// environmentPyramid, and lightPyramid of emissive triangles: scene/device/tables/weight_pyramid.h.

// ggxTable: GGX_TABLE_SIZE^2 texels, row = roughness, column = cosine: A, B (directional albedo is F0 A + F90
// B), and q, d of metals' multiple scattering (docs/gltf.md). Then a texel for each row: the cosine-weighted
// averages of A and B, and the share of multiple scattering with a diffuse distribution.
LIMPID_CONST uint GGX_TABLE_SIZE = 32u;
// In scenes with sheen, SHEEN_TABLE_SIZE^2 texels follow: x is the albedo of the sheen's lobe, row =
// roughness, column = square root of the cosine (scene/device/tables/sheen_table.cpp).
LIMPID_CONST uint SHEEN_TABLE_SIZE = 32u;
LIMPID_CONST float MIN_SHEEN_ROUGHNESS = 0.07;  // a narrower lobe would reflect grazing light only
// dielectricTable: multiple scattering at a rough refracting surface, [eta][roughness][cosine], two texels
// each: gain of the reflecting and of the transmitting lobe, albedo of the diffuse-like reflection and
// transmission | these two albedos again, their cosine-weighted averages over the row. The first
// DIELECTRIC_ETA_NODES are for eta (index behind over index in front) below 1, the others for above, since
// total reflection makes these two different functions. Node i has log(1 + (|log eta| - e) / ETA_SCALE)
// proportional to i, with e = log(1 + SMOOTH_IOR_DIFFERENCE): dense near 1. The column of a cosine c is c (1
// + k) / (c + k) (SIZE - 1), where k is the cosine at which total reflection begins on the denser side.
LIMPID_CONST uint DIELECTRIC_TABLE_SIZE = 20u;
LIMPID_CONST uint DIELECTRIC_ETA_NODES = 32u;
LIMPID_CONST float DIELECTRIC_ETA_MAX = 3.0;
LIMPID_CONST float DIELECTRIC_ETA_SCALE = 0.005;

// Roughness below this is a perfect mirror: its lobe is too narrow for float32 to sample and weigh.
LIMPID_CONST float SMOOTH_ROUGHNESS = 0.03;
// A refractive index closer to 1 than this lets light pass straight through, however rough the surface is.
LIMPID_CONST float SMOOTH_IOR_DIFFERENCE = 1e-3;
// Reflectance of a clear coat at normal incidence: index 1.5 (KHR_materials_clearcoat).
LIMPID_CONST float CLEARCOAT_F0 = 0.04;

/// Scene parameters for shaders, besides the buffers.
struct SceneParams {
    vec3 sceneCenter;
    float sceneRadius;
    uint triangleLightCount;  // number in `lights`; punctual lights follow
    uint punctualCount;
    uint sunCount;                 // directional lights among them
    uint firstLightTrail;          // texel of lightTree where trails begin
    uint firstSun;                 // texel of lightTree where the list of directional lights begins
    float environmentProbability;  // of choosing the environment in next-event estimation
    uint environmentIsEven;        // 1: its directions are sampled by the cosine at the surface, not by texel
    float triangleLightProbability;  // of triangles rather than punctual lights, at points that a punctual
                                     // light reaches
    uint environmentWidth;
    uint environmentHeight;
    vec3 environmentScale;    // multiplies its radiance
    float environmentTurn;    // rotation about +Y as a fraction of a full circle: added to the direction's u
    uint rootNode;            // of the tree in which rays start
    uint previousVertexBase;  // texel of previousGeometry where vertices begin
};

/// How the pose pass deforms the vertices of one instance. Texel indices count from the start of the buffer;
/// NONE: no skin, or no weights.
struct PoseParams {
    uint firstVertex;
    uint vertexCount;
    uint morphFirst;  // texel in morphDeltas
    uint targetCount;
    uint matricesNow;  // texel in poseMatrices
    uint matricesBefore;
    uint weightsNow;
    uint weightsBefore;
    uint previousBase;   // texel in previousGeometry where vertices begin
    uint hasVertexData;  // 1 if there are normals and tangents to write
};

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid::layout
#endif
#endif
