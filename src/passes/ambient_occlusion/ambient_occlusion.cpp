#include "passes/ambient_occlusion/ambient_occlusion.h"

#include <algorithm>
#include <string>

#include "ambient_occlusion.comp.h"
#include "ambient_occlusion.rgen.h"
#include "ambient_occlusion_signal.comp.h"
#include "passes/ambient_occlusion/ambient_occlusion_params.h"
#include "passes/sobol_points.h"
#include "passes/traced_dispatch.h"

namespace limpid {
namespace {

/// lavapipe ends all loops of an invocation after 65,535 iterations in total; a ray may need two thousand.
/// More rays would be silently lost.
constexpr uint32_t maxRaysPerDispatch = 32;
constexpr float unlimited = 1e30f;  ///< equals INFINITE_DISTANCE in shaders/trace/trace.glsl

/// Returns the name of the dispatch that begins with this ray; the last one has the pass's own name.
std::string passName(uint32_t firstRay, uint32_t rays) {
    const bool last = rays - firstRay <= maxRaysPerDispatch;
    return last ? "ambient_occlusion" : "ambient_occlusion/" + std::to_string(firstRay);
}

}  // namespace

const ParamTable<AmbientOcclusionSettings>& ambientOcclusionParams() {
    static const auto table = [] {
        using S = AmbientOcclusionSettings;
        ParamTable<S> t("ao");
        t.add("radius", &S::radius, 0, 1000, "scene radii",
              "Distance up to which geometry occludes; higher darkens more; 0 is no limit, as under a white "
              "sky")
            .slider(0, 10, SliderScale::Logarithmic, 0.01);
        t.add("rays", &S::rays, 1, 1024, "", "Rays per pixel and frame; more is less noisy and slower")
            .slider(1, 64, SliderScale::Logarithmic);
        return t;
    }();
    return table;
}

std::vector<gpu::ImageHandle> makeAmbientOcclusionImages(gpu::FrameGraph& graph,
                                                         const AmbientOcclusionSettings& settings,
                                                         gpu::Extent extent) {
    const auto rays = static_cast<uint32_t>(settings.rays);
    std::vector<gpu::ImageHandle> images;
    for (uint32_t first = 0; first < rays; first += maxRaysPerDispatch)
        images.push_back(graph.transient(passName(first, rays), gpu::Format::RGBA32Float, extent));
    return images;
}

gpu::ImageHandle ambientOcclusion(gpu::FrameGraph& graph, const scene::GpuScene& scene,
                                  const AmbientOcclusionSettings& settings,
                                  const AmbientOcclusionLaunch& launch, const GBufferImages& gbuffer,
                                  std::span<const gpu::ImageHandle> into) {
    const gpu::Extent extent = graph.extent(gbuffer.position);
    const auto rays = static_cast<uint32_t>(settings.rays);
    AmbientOcclusionParams params{};
    params.scene = scene.params();
    params.width = extent.width;
    params.height = extent.height;
    params.stream = launch.stream;
    params.seed = launch.seed;
    params.reach = settings.radius > 0.0f ? settings.radius * params.scene.sceneRadius : unlimited;
    // The first dispatch does not read `before`, but an image must be bound.
    gpu::ImageHandle open = gbuffer.position;
    for (const gpu::ImageHandle after : into) {
        params.rays = std::min(rays - params.firstRay, maxRaysPerDispatch);
        params.points = sobolTable(
            launch.sampler, launch.seed ^ OCCLUSION_STREAMS,
            {.first = launch.firstPoint * rays + params.firstRay, .count = params.rays, .draws = 1});
        params.divisor = params.firstRay + params.rays == rays ? static_cast<float>(rays) : 1.0f;
        dispatchTraced(graph, scene, passName(params.firstRay, rays),
                       {shaders::ambient_occlusion_comp, shaders::ambient_occlusion_rgen},
                       {{"position", gbuffer.position},
                        {"geometricNormal", gbuffer.geometricNormal},
                        {"normal", gbuffer.normal},
                        {"before", open},
                        {"openness", after}},
                       gpu::paramsOf(params), {{"SAMPLER", static_cast<uint32_t>(launch.sampler)}}, extent);
        params.firstRay += params.rays;
        open = after;
    }
    return open;
}

gpu::ImageHandle ambientOcclusion(gpu::FrameGraph& graph, const scene::GpuScene& scene,
                                  const AmbientOcclusionSettings& settings,
                                  const AmbientOcclusionLaunch& launch, const GBufferImages& gbuffer) {
    return ambientOcclusion(graph, scene, settings, launch, gbuffer,
                            makeAmbientOcclusionImages(graph, settings, graph.extent(gbuffer.position)));
}

void ambientOcclusionSignal(gpu::FrameGraph& graph, gpu::ImageHandle openness, gpu::ImageHandle depth,
                            const AmbientOcclusionSignal& into) {
    const gpu::Extent extent = graph.extent(openness);
    const AmbientOcclusionSignalParams params{extent.width, extent.height};
    graph.dispatch({.pass = "ambient_occlusion/signal",
                    .shader = shaders::ambient_occlusion_signal_comp,
                    .bindings = {{"openness", openness},
                                 {"depth", depth},
                                 {"diffuse", into.diffuse},
                                 {"specular", into.specular},
                                 {"emission", into.emission},
                                 {"albedo", into.albedo},
                                 {"albedoSpecular", into.albedoSpecular},
                                 {"reflectionMotion", into.reflectionMotion},
                                 {"hitDistance", into.hitDistance}},
                    .params = gpu::paramsOf(params),
                    .constants = {},
                    .extent = extent});
}

}  // namespace limpid
