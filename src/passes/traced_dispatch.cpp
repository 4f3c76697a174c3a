#include "passes/traced_dispatch.h"

#include "shaders/trace/ray_shaders.h"

namespace limpid {

void dispatchTraced(gpu::FrameGraph& graph, const scene::GpuScene& scene, std::string_view pass,
                    const TracerShaders& shaders, const std::vector<gpu::Binding>& images,
                    std::span<const std::byte> params, const std::vector<gpu::ConstantValue>& constants,
                    gpu::Extent extent) {
    std::vector<gpu::Binding> bindings = scene.bindings();
    bindings.insert(bindings.end(), images.begin(), images.end());
    std::vector<gpu::ConstantValue> allConstants = scene.constants();
    allConstants.insert(allConstants.end(), constants.begin(), constants.end());
    const bool hardware = scene.tracer() == scene::Tracer::Hardware;
    graph.dispatch({.pass = pass,
                    .shader = hardware ? shaders.rayGeneration : shaders.compute,
                    .bindings = std::move(bindings),
                    .params = params,
                    .constants = std::move(allConstants),
                    .extent = extent,
                    .rays = hardware ? &rayShaders() : nullptr});
}

}  // namespace limpid
