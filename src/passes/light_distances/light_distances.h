// Maps of how far each point light and spot light can be seen, so that next-event estimation can tell lights
// that are hidden from a point (shaders/material/light_distances.glsl).
#pragma once

#include "gpu/graph/frame_graph.h"
#include "scene/device/gpu_scene.h"

namespace limpid {

/// Records the passes "light_distances/first_hits" and "light_distances", which fill the scene's buffer
/// "lightDistances" (scene_layout.h): an octahedral map for each of the first LIGHT_MAPS punctual lights. A
/// texel has two distances, as upper halves of floats, with margins (light_distances_params.h). Lower 16
/// bits: the farthest first hit of LIGHT_MAP_RAYS^2 rays through the texel; beyond it the light is probably
/// hidden. Upper 16 bits: the farthest of the 3x3 texels around it, and never less than the other; beyond it
/// the light is almost surely hidden. At least LIGHT_MAP_NOT_HIDDEN if a ray meets nothing, and for
/// directional lights. Rays always have the same directions, so equal scenes have equal maps. Call it while
/// scene.mappedLights() > 0 and when anything that shadow rays meet, or a light, has moved.
void lightDistances(gpu::FrameGraph& graph, const scene::GpuScene& scene);

}  // namespace limpid
