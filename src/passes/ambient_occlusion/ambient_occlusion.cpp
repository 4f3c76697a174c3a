#include "passes/ambient_occlusion/ambient_occlusion.h"

#include <algorithm>

#include "ambient_occlusion.comp.h"
#include "ambient_occlusion.rgen.h"
#include "passes/ambient_occlusion/ambient_occlusion_params.h"
#include "passes/traced_dispatch.h"

namespace limpid {
namespace {

/// lavapipe ends every loop of an invocation once it has gone round 65,535 times in all; a ray may take two
/// thousand. More rays would be lost without a word.
constexpr uint32_t maxRaysPerDispatch = 32;
constexpr float unlimited = 1e30f;  ///< INFINITE_DISTANCE of shaders/trace/trace.glsl

}  // namespace

const ParamTable<AmbientOcclusionSettings>& ambientOcclusionParams() {
    static const auto table = [] {
        using S = AmbientOcclusionSettings;
        ParamTable<S> t("ao");
        t.add("radius", &S::radius, 0, 1000, "scene radii",
              "how far away things still darken; 0 has no limit and shows what a white sky would light")
            .slider(0, 10, SliderScale::Logarithmic, 0.01);
        t.add("rays", &S::rays, 1, 1024, "", "per pixel and frame; more is slower and less noisy")
            .slider(1, 64, SliderScale::Logarithmic);
        return t;
    }();
    return table;
}

gpu::ImageHandle ambientOcclusion(gpu::FrameGraph& graph, const scene::GpuScene& scene,
                                  const AmbientOcclusionSettings& settings,
                                  const AmbientOcclusionLaunch& launch, const GBufferImages& gbuffer) {
    const gpu::Extent extent = graph.extent(gbuffer.position);
    const auto rays = static_cast<uint32_t>(settings.rays);
    AmbientOcclusionParams params{};
    params.scene = scene.params();
    params.width = extent.width;
    params.height = extent.height;
    params.stream = launch.stream;
    params.seed = launch.seed;
    params.reach = settings.radius > 0.0f ? settings.radius * params.scene.sceneRadius : unlimited;
    // The first dispatch does not read `before`, but something must be bound.
    gpu::ImageHandle open = gbuffer.position;
    for (uint32_t first = 0; first < rays; first += params.rays) {
        params.firstRay = first;
        params.rays = std::min(rays - first, maxRaysPerDispatch);
        const bool last = first + params.rays == rays;
        params.divisor = last ? static_cast<float>(rays) : 1.0f;
        const std::string name = last ? "ambient_occlusion" : "ambient_occlusion/" + std::to_string(first);
        const gpu::ImageHandle after = graph.transient(name, gpu::Format::RGBA32Float, extent);
        dispatchTraced(graph, scene, name, {shaders::ambient_occlusion_comp, shaders::ambient_occlusion_rgen},
                       {{"position", gbuffer.position},
                        {"geometricNormal", gbuffer.geometricNormal},
                        {"normal", gbuffer.normal},
                        {"before", open},
                        {"openness", after}},
                       gpu::paramsOf(params), {{"SAMPLER_TEA", launch.samplerTea ? 1u : 0u}}, extent);
        open = after;
    }
    return open;
}

}  // namespace limpid
