#include "passes/pathtrace/pathtrace.h"

#include "passes/camera_launch.h"
#include "passes/sobol_points.h"
#include "passes/traced_dispatch.h"
#include "pathtrace.comp.h"
#include "pathtrace.rgen.h"
#include "pathtrace_layers.comp.h"
#include "pathtrace_layers.rgen.h"
#include "pathtrace_layers_filters.comp.h"
#include "pathtrace_layers_filters.rgen.h"

namespace limpid {
namespace {

using gpu::Binding;
using gpu::Format;
using gpu::FrameGraph;
using gpu::ImageHandle;

PathtraceParams makeParams(const scene::GpuScene& scene, const PathtraceSettings& settings,
                           const PathtraceLaunch& launch) {
    PathtraceParams params{};
    params.points =
        sobolTable(launch.sampler, launch.seed, {.first = launch.firstPoint, .count = launch.samples});
    params.scene = scene.params();
    params.view = viewParams(launch);
    params.samples = launch.samples;
    params.maxDepth = static_cast<uint>(settings.maxDepth);
    params.maxTransmissionDepth = static_cast<uint>(settings.maxTransmissionDepth);
    params.rouletteDepth = static_cast<uint>(settings.rouletteDepth);
    params.fireflyClamp = settings.fireflyClamp;
    params.throughMirrors = settings.throughMirrors;
    params.throughGlass = settings.throughGlass;
    return params;
}

void dispatch(FrameGraph& graph, const TracerShaders& shaders, const scene::GpuScene& scene,
              const PathtraceSettings& settings, const PathtraceLaunch& launch,
              const std::vector<Binding>& images) {
    const PathtraceParams params = makeParams(scene, settings, launch);
    dispatchTraced(graph, scene, "pathtrace", shaders, images, gpu::paramsOf(params),
                   {{"SAMPLER", static_cast<uint32_t>(launch.sampler)},
                    {"LIGHT_TREE", scene.usesLightTree(settings.lightTree) ? 1u : 0u},
                    {"HAS_LENS", launch.camera.lensRadius > 0.0f ? 1u : 0u}},
                   launch.extent);
}

}  // namespace

const ParamTable<PathtraceSettings>& pathtraceParams() {
    static const auto table = [] {
        using S = PathtraceSettings;
        ParamTable<S> t("pathtrace");
        t.add("max_depth", &S::maxDepth, 0, 1024, "bounces",
              "Maximum number of scattering events of a path; 0 shows emitters only, more adds indirect "
              "light and time")
            .slider(0, 32);
        t.add("max_transmission_depth", &S::maxTransmissionDepth, 0, 1024, "passages",
              "Maximum number of passages through glass, including inner reflections; passages beyond it "
              "count as bounces of max_depth; more is brighter in glass and slower")
            .slider(0, 64);
        t.add("roulette_depth", &S::rouletteDepth, 0, 1024, "bounces",
              "Bounce from which dark paths end at random (unbiased); lower is faster and noisier")
            .slider(0, 32);
        t.add("firefly_clamp", &S::fireflyClamp, 0, 1e9, "cd/m^2",
              "Maximum brightness of an indirect sample (biased); lower removes more fireflies and light; 0 "
              "is off")
            .slider(0, 1000, SliderScale::Logarithmic, 0.01);
        t.add("sampler_tea", &S::samplerTea,
              "Use the low 24 bits of a linear congruential generator instead of PCG, as many tutorials do; "
              "more correlated");
        t.add("sampler_sobol", &S::samplerSobol,
              "Spread random numbers evenly over a pixel's samples and its neighbours: Owen-scrambled Sobol' "
              "points; less noise, and blue noise; sampler_tea wins");
        t.add("through_mirrors", &S::throughMirrors,
              "Write the layers of what a perfect mirror shows, which helps denoisers; off: the mirror's own "
              "layers");
        t.add("through_glass", &S::throughGlass,
              "Write the layers of what smooth glass shows, or of what it mirrors where it mirrors more, "
              "which helps denoisers, and trace that light for every sample; off: the glass's own layers");
        t.add(
            "light_tree", &S::lightTree,
            "Where choosing lights by power would starve some lamp of samples, choose them by what each can "
            "send to the point, by a tree over all lights; off: by power, unless there are more than 256 "
            "point and spot lights");
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

PathtraceLayers makePathtraceLayers(FrameGraph& graph, const std::string& prefix, gpu::Extent extent,
                                    bool forFilters) {
    PathtraceLayers layers;
    for (const LayerInfo& layer : frameLayers) {
        if (forFilters && layer.forFilters == ForFilters::Nothing) continue;
        Format format = Format::RGBA32Float;
        if (forFilters && layer.forFilters == ForFilters::Halves) format = Format::RGBA16Float;
        if (forFilters && layer.forFilters == ForFilters::OneHalf) format = Format::R16Float;
        if (layer.stored == Stored::Uint) format = Format::RG32Uint;
        layers[layer] = graph.transient(prefix + std::string(layer.member), format, extent);
    }
    return layers;
}

void pathtraceLayers(FrameGraph& graph, const scene::GpuScene& scene, const PathtraceSettings& settings,
                     const PathtraceLaunch& launch, ImageHandle countersBefore, const PathtraceLayers& into) {
    std::vector<Binding> images{{"countersBefore", countersBefore}, {"counters", into.counters}};
    for (const LayerInfo& layer : frameLayers)
        if (into[layer]) images.push_back({layer.member, into[layer]});
    const bool forFilters = graph.format(into.diffuse) == Format::RGBA16Float;
    const TracerShaders shaders =
        forFilters
            ? TracerShaders{shaders::pathtrace_layers_filters_comp, shaders::pathtrace_layers_filters_rgen}
            : TracerShaders{shaders::pathtrace_layers_comp, shaders::pathtrace_layers_rgen};
    dispatch(graph, shaders, scene, settings, launch, images);
}

PathtraceLayers pathtraceLayers(FrameGraph& graph, const scene::GpuScene& scene,
                                const PathtraceSettings& settings, const PathtraceLaunch& launch) {
    PathtraceLayers layers = makePathtraceLayers(graph, "pathtrace/", launch.extent);
    const gpu::History counters = graph.history("pathtrace/counters", Format::RG32Uint, launch.extent);
    layers.counters = counters.current;
    pathtraceLayers(graph, scene, settings, launch, counters.previous, layers);
    return layers;
}

}  // namespace limpid
