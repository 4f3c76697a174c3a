// Maps of how far each point light and spot light can be seen, so that next-event estimation can tell lights
// that are hidden from a point (shaders/material/light_distances.glsl).
#pragma once

#include "gpu/graph/frame_graph.h"
#include "scene/device/gpu_scene.h"

namespace limpid {

/// Records the passes "light_distances/first_hits" and "light_distances", which fill the scene's buffer
/// "lightDistances" (scene_layout.h): an octahedral map for each of the first LIGHT_MAPS punctual lights. A
/// texel is the distance of the farthest first hit of LIGHT_MAP_RAYS^2 rays through each of the 3x3 texels
/// around it, times LIGHT_MAP_MARGIN; infinite if one of these rays meets nothing, and for directional
/// lights. Rays have fixed directions, so equal scenes have equal maps. Call it while scene.mappedLights() >
/// 0 and when anything that shadow rays meet, or a light, has moved.
void lightDistances(gpu::FrameGraph& graph, const scene::GpuScene& scene);

}  // namespace limpid
