#include "passes/light_distances/light_distances.h"

#include "light_distances.comp.h"
#include "light_first_hits.comp.h"
#include "light_first_hits.rgen.h"
#include "passes/light_distances/light_distances_params.h"
#include "passes/traced_dispatch.h"

namespace limpid {

void lightDistances(gpu::FrameGraph& graph, const scene::GpuScene& scene) {
    const LightDistancesParams params{scene.params(), scene.mappedLights()};
    const gpu::Extent extent{layout::LIGHT_MAP_SIZE, layout::LIGHT_MAP_SIZE * params.maps};
    const gpu::Buffer& firstHits = scene.buffer("lightFirstHits");
    dispatchTraced(graph, scene, "light_distances/first_hits",
                   {shaders::light_first_hits_comp, shaders::light_first_hits_rgen},
                   {{"lightFirstHits", &firstHits}}, gpu::paramsOf(params), {}, extent);
    graph.dispatch(
        {.pass = "light_distances",
         .shader = shaders::light_distances_comp,
         .bindings = {{"lightFirstHits", &firstHits}, {"lightDistances", &scene.buffer("lightDistances")}},
         .params = gpu::paramsOf(params),
         .constants = {},
         .extent = extent});
}

}  // namespace limpid
