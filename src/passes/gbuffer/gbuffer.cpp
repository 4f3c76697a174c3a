#include "passes/gbuffer/gbuffer.h"

#include "gbuffer.comp.h"
#include "gbuffer.rgen.h"
#include "passes/gbuffer/gbuffer_params.h"
#include "passes/sobol_points.h"
#include "passes/traced_dispatch.h"

namespace limpid {

using gpu::Format;
using gpu::ImageHandle;

const ParamTable<GBufferSettings>& gbufferParams() {
    static const auto table = [] {
        using S = GBufferSettings;
        ParamTable<S> t("gbuffer");
        t.add("light", &S::light, "Compute direct light; off: black, faster");
        t.add("shadows", &S::shadows, "Trace shadow rays for direct light; off: no shadows, faster");
        return t;
    }();
    return table;
}

GBufferImages makeGBufferImages(gpu::FrameGraph& graph, gpu::Extent extent, GBufferImages given) {
    const auto make = [&](std::string_view name, ImageHandle& handle, Format format = Format::RGBA32Float) {
        if (!handle) handle = graph.transient("gbuffer/" + std::string(name), format, extent);
    };
    make("light", given.light);
    make("position", given.position);
    make("geometricNormal", given.geometricNormal);
    for (const LayerInfo& layer : frameLayers) {
        if (!layer.ofFirstHit) continue;
        make(layer.member, given[layer],
             layer.stored == Stored::Uint ? Format::RG32Uint : Format::RGBA32Float);
    }
    return given;
}

void gbuffer(gpu::FrameGraph& graph, const scene::GpuScene& scene, const GBufferSettings& settings,
             const CameraLaunch& launch, ImageHandle countersBefore, const GBufferImages& into) {
    std::vector<gpu::Binding> bindings{{"countersBefore", countersBefore},
                                       {"counters", into.counters},
                                       {"light", into.light},
                                       {"position", into.position},
                                       {"geometricNormal", into.geometricNormal}};
    for (const LayerInfo& layer : frameLayers)
        if (layer.ofFirstHit) bindings.push_back({layer.member, into[layer]});
    const GBufferParams params{sobolTable(launch.sampler, launch.seed, {.first = launch.firstPoint}),
                               scene.params(), viewParams(launch)};
    dispatchTraced(graph, scene, "gbuffer", {shaders::gbuffer_comp, shaders::gbuffer_rgen}, bindings,
                   gpu::paramsOf(params),
                   {{"LIGHT", settings.light ? 1u : 0u},
                    {"SHADOWS", settings.shadows ? 1u : 0u},
                    {"SAMPLER", static_cast<uint32_t>(launch.sampler)}},
                   launch.extent);
}

GBufferImages gbuffer(gpu::FrameGraph& graph, const scene::GpuScene& scene, const GBufferSettings& settings,
                      const CameraLaunch& launch) {
    const gpu::History counters = graph.history("gbuffer/counters", Format::RG32Uint, launch.extent);
    GBufferImages images = makeGBufferImages(graph, launch.extent);
    images.counters = counters.current;
    gbuffer(graph, scene, settings, launch, counters.previous, images);
    return images;
}

}  // namespace limpid
