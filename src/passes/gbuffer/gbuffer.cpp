#include "passes/gbuffer/gbuffer.h"

#include "gbuffer.comp.h"
#include "gbuffer.rgen.h"
#include "passes/gbuffer/gbuffer_params.h"
#include "passes/traced_dispatch.h"

namespace limpid {

using gpu::Format;
using gpu::ImageHandle;

const ParamTable<GBufferSettings>& gbufferParams() {
    static const auto table = [] {
        using S = GBufferSettings;
        ParamTable<S> t("gbuffer");
        t.add("light", &S::light, "light that arrives directly is computed; off is black and faster");
        t.add("shadows", &S::shadows, "lights are hidden by what stands before them; off is faster");
        return t;
    }();
    return table;
}

GBufferImages gbuffer(gpu::FrameGraph& graph, const scene::GpuScene& scene, const GBufferSettings& settings,
                      const CameraLaunch& launch) {
    GBufferImages images;
    const gpu::History counters = graph.history("gbuffer/counters", Format::RG32Uint, launch.extent);
    images.counters = counters.current;
    images.ids = graph.transient("gbuffer/ids", Format::RG32Uint, launch.extent);
    std::vector<gpu::Binding> bindings{
        {"countersBefore", counters.previous}, {"counters", counters.current}, {"ids", images.ids}};
    const auto image = [&](const char* name, ImageHandle& handle) {
        handle = graph.transient(std::string("gbuffer/") + name, Format::RGBA32Float, launch.extent);
        bindings.push_back({name, handle});
    };
    image("light", images.light);
    image("emission", images.emission);
    image("albedo", images.albedo);
    image("albedoSpecular", images.albedoSpecular);
    image("normal", images.normal);
    image("depth", images.depth);
    image("motion", images.motion);
    image("previousNormal", images.previousNormal);
    image("position", images.position);
    image("geometricNormal", images.geometricNormal);
    const GBufferParams params{scene.params(), viewParams(launch)};
    dispatchTraced(graph, scene, "gbuffer", {shaders::gbuffer_comp, shaders::gbuffer_rgen}, bindings,
                   gpu::paramsOf(params),
                   {{"LIGHT", settings.light ? 1u : 0u},
                    {"SHADOWS", settings.shadows ? 1u : 0u},
                    {"SAMPLER_TEA", launch.samplerTea ? 1u : 0u}},
                   launch.extent);
    return images;
}

}  // namespace limpid
