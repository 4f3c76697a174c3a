// The scene's buffers (layout: scene_layout.h), and specialisation constants that remove features a scene
// does not use. lavapipe runs both sides of every `if`, so removing code here makes it several times faster.
#ifndef LIMPID_SCENE_DATA_GLSL
#define LIMPID_SCENE_DATA_GLSL

#include "shaders/common/scene_layout.h"

layout(constant_id = 0) const bool TWO_LEVEL = true;         // instances above the static tree
layout(constant_id = 1) const bool HAS_VERTEX_DATA = true;   // normals, coordinates, tangents or colours
layout(constant_id = 2) const bool HAS_TEXTURES = true;
layout(constant_id = 3) const bool HAS_ALPHA = true;         // masked or blended materials
layout(constant_id = 4) const bool HAS_SPECULAR = true;      // anything that is not Lambertian
layout(constant_id = 5) const bool HAS_TRANSMISSION = true;
layout(constant_id = 6) const bool HAS_TRIANGLE_LIGHTS = true;
layout(constant_id = 7) const bool HAS_PUNCTUAL_LIGHTS = true;
layout(constant_id = 8) const bool HAS_ENVIRONMENT = true;
layout(constant_id = 9) const int STACK_SIZE = 64;           // traversal stack entries
layout(constant_id = 11) const bool HAS_MIRRORED = true;      // instances with a negative determinant
layout(constant_id = 10) const int TEXEL_BUFFER_COUNT = 1;   // of texels0..3 in use
layout(constant_id = 12) const bool CPU_LOOPS = false;          // for CPUs, where branches cannot skip code
layout(constant_id = 17) const bool EXPANDED_NODES = false;     // the format of bvhNodes
layout(constant_id = 13) const bool HAS_MOTION = false;         // something moves from frame to frame
layout(constant_id = 14) const bool HAS_CLEARCOAT = true;
layout(constant_id = 15) const bool HAS_VOLUME = true;        // bodies that absorb light
layout(constant_id = 16) const bool HAS_SPECULAR_TEXTURES = true;
layout(constant_id = 18) const bool HAS_ROUGH_GLASS = true;   // rough boundaries that refract
layout(constant_id = 26) const bool HAS_ANISOTROPY = true;
layout(constant_id = 27) const bool HAS_SHEEN = true;
layout(constant_id = 28) const bool HAS_DIFFUSE_TRANSMISSION = true;
layout(constant_id = 29) const bool HAS_DISPERSION = true;
layout(constant_id = 30) const bool HAS_IRIDESCENCE = true;
layout(constant_id = 32) const bool HAS_PANES = true;  // smooth surfaces that light goes straight through
layout(constant_id = 33) const bool HAS_BLENDED = true;       // BLEND materials
layout(constant_id = 19) const bool HAS_LIGHT_TREE = false;    // several lights that are not directional
layout(constant_id = 23) const bool HAS_SUNS = true;          // directional lights
layout(constant_id = 31) const bool HAS_LIGHT_DISTANCES = false;  // several point and spot lights
// A setting of the pass, not of the scene: choose lights by the tree, else by power.
layout(constant_id = 24) const bool LIGHT_TREE = true;

layout(set = 0, binding = 0, rgba32ui) uniform readonly uimageBuffer bvhNodes;
layout(set = 0, binding = 1, rgba32f) uniform readonly imageBuffer bvhTriangles;
layout(set = 0, binding = 2, rgba32ui) uniform readonly uimageBuffer bvhInstances;
layout(set = 0, binding = 3, rgba32ui) uniform readonly uimageBuffer triangles;
layout(set = 0, binding = 4, rgba32ui) uniform readonly uimageBuffer vertices;
layout(set = 0, binding = 5, rgba32ui) uniform readonly uimageBuffer instances;
layout(set = 0, binding = 6, rgba32ui) uniform readonly uimageBuffer materials;
layout(set = 0, binding = 7, rgba32ui) uniform readonly uimageBuffer textureRefs;
layout(set = 0, binding = 8, rgba32ui) uniform readonly uimageBuffer lights;
layout(set = 0, binding = 9, rgba32f) uniform readonly imageBuffer lightPyramid;
layout(set = 0, binding = 10, r32f) uniform readonly imageBuffer lightDensity;
layout(set = 0, binding = 11, rgba32f) uniform readonly imageBuffer environment;
layout(set = 0, binding = 12, rgba32f) uniform readonly imageBuffer environmentPyramid;
layout(set = 0, binding = 13, rgba32f) uniform readonly imageBuffer ggxTable;
layout(set = 0, binding = 14, rgba32f) uniform readonly imageBuffer dielectricTable;
layout(set = 0, binding = 15, r32ui) uniform readonly uimageBuffer texels0;
layout(set = 0, binding = 16, r32ui) uniform readonly uimageBuffer texels1;
layout(set = 0, binding = 17, r32ui) uniform readonly uimageBuffer texels2;
layout(set = 0, binding = 18, r32ui) uniform readonly uimageBuffer texels3;
layout(set = 0, binding = 19, rgba32ui) uniform readonly uimageBuffer previousGeometry;
layout(set = 0, binding = 62, rgba32ui) uniform readonly uimageBuffer lightTree;
layout(set = 0, binding = 61, r32f) uniform readonly imageBuffer lightDistances;
// Bindings from 20 to 60 belong to the pass that includes this file.

#endif
