#include "passes/pathtrace/pathtrace.h"

#include "passes/camera_launch.h"
#include "passes/traced_dispatch.h"
#include "pathtrace.comp.h"
#include "pathtrace.rgen.h"
#include "pathtrace_layers.comp.h"
#include "pathtrace_layers.rgen.h"

namespace limpid {
namespace {

using gpu::Binding;
using gpu::Format;
using gpu::FrameGraph;
using gpu::ImageHandle;

PathtraceParams makeParams(const scene::GpuScene& scene, const PathtraceSettings& settings,
                           const PathtraceLaunch& launch) {
    PathtraceParams params{};
    params.scene = scene.params();
    params.view = viewParams(launch);
    params.samples = launch.samples;
    params.maxDepth = static_cast<uint>(settings.maxDepth);
    params.rouletteDepth = static_cast<uint>(settings.rouletteDepth);
    params.fireflyClamp = settings.fireflyClamp;
    return params;
}

void dispatch(FrameGraph& graph, const TracerShaders& shaders, const scene::GpuScene& scene,
              const PathtraceSettings& settings, const PathtraceLaunch& launch,
              const std::vector<Binding>& images) {
    const PathtraceParams params = makeParams(scene, settings, launch);
    dispatchTraced(graph, scene, "pathtrace", shaders, images, gpu::paramsOf(params),
                   {{"SAMPLER_TEA", settings.samplerTea ? 1u : 0u}}, launch.extent);
}

}  // namespace

const ParamTable<PathtraceSettings>& pathtraceParams() {
    static const auto table = [] {
        using S = PathtraceSettings;
        ParamTable<S> t("pathtrace");
        t.add("max_depth", &S::maxDepth, 0, 1024, "bounces",
              "scattering events of a path; 0 shows emitters only, more adds indirect light and time");
        t.add(
            "roulette_depth", &S::rouletteDepth, 0, 1024, "bounces",
            "from this bounce on, dark paths are ended at random (unbiased); earlier is faster and noisier");
        t.add("firefly_clamp", &S::fireflyClamp, 0, 1e9, "cd/m^2",
              "biased: indirect samples brighter than this are dimmed to it; 0 is off");
        t.add("sampler_tea", &S::samplerTea,
              "the seed document's generator (24 low bits of an LCG) instead of PCG");
        return t;
    }();
    return table;
}

PathtraceBeauty pathtraceBeauty(FrameGraph& graph, const scene::GpuScene& scene,
                                const PathtraceSettings& settings, const PathtraceLaunch& launch) {
    const ImageHandle beauty = graph.transient("pathtrace/beauty", Format::RGBA32Float, launch.extent);
    const gpu::History counters = graph.history("pathtrace/counters", Format::RG32Uint, launch.extent);
    dispatch(graph, {shaders::pathtrace_comp, shaders::pathtrace_rgen}, scene, settings, launch,
             {{"beauty", beauty}, {"countersBefore", counters.previous}, {"counters", counters.current}});
    return {beauty, counters.current};
}

PathtraceLayers pathtraceLayers(FrameGraph& graph, const scene::GpuScene& scene,
                                const PathtraceSettings& settings, const PathtraceLaunch& launch) {
    PathtraceLayers layers;
    const gpu::History counters = graph.history("pathtrace/counters", Format::RG32Uint, launch.extent);
    layers.counters = counters.current;
    layers.ids = graph.transient("pathtrace/ids", Format::RG32Uint, launch.extent);
    std::vector<Binding> images{
        {"countersBefore", counters.previous}, {"counters", counters.current}, {"ids", layers.ids}};
    const auto image = [&](const char* name, ImageHandle& handle) {
        handle = graph.transient(std::string("pathtrace/") + name, Format::RGBA32Float, launch.extent);
        images.push_back({name, handle});
    };
    image("diffuse", layers.diffuse);
    image("specular", layers.specular);
    image("emission", layers.emission);
    image("albedo", layers.albedo);
    image("albedoSpecular", layers.albedoSpecular);
    image("normal", layers.normal);
    image("depth", layers.depth);
    image("motion", layers.motion);
    image("previousNormal", layers.previousNormal);
    dispatch(graph, {shaders::pathtrace_layers_comp, shaders::pathtrace_layers_rgen}, scene, settings, launch,
             images);
    return layers;
}

}  // namespace limpid
