#include "denoise/methods/temporal/temporal.h"

#include <algorithm>
#include <limits>

#include "denoise/methods/methods.h"
#include "denoise/stages/compose/compose.h"
#include "denoise/stages/surfaces/surfaces.h"
#include "temporal_accumulate.comp.h"
#include "temporal_accumulate_buffers.comp.h"
#include "temporal_show.comp.h"

namespace limpid::denoise {
namespace {

TemporalParams makeParams(gpu::Extent extent, const DenoiserInput& input, const TemporalSettings& settings) {
    TemporalParams params{};
    params.camera = input.camera;
    params.width = extent.width;
    params.height = extent.height;
    params.tests = {.normal = settings.normal,
                    .depth = settings.depth,
                    .relative = settings.relative,
                    .search = settings.search,
                    .previousNormals = input.normalEncoding,
                    .motion = input.motionEncoding};
    params.identity = settings.identity;
    params.minAlbedo = settings.demodulate ? settings.minAlbedo : 0.0f;
    params.greyRestart = settings.greyRestart;
    params.greyMisses = settings.greyMisses;
    params.grey = settings.grey;
    // A history of less than one frame would weigh the new sample more than once, and the mean would diverge.
    params.maxHistory =
        settings.maxHistory > 0.0f ? std::max(settings.maxHistory, 1.0f) : std::numeric_limits<float>::max();
    return params;
}

gpu::ImageHandle showDisocclusion(gpu::FrameGraph& graph, gpu::ImageHandle beauty,
                                  gpu::ImageHandle disocclusion) {
    const gpu::Extent extent = graph.extent(beauty);
    const gpu::ImageHandle shown = graph.transient("temporal/shown", gpu::Format::RGBA32Float, extent);
    const TemporalShowParams params{extent.width, extent.height};
    graph.dispatch({.pass = "temporal/show",
                    .shader = shaders::temporal_show_comp,
                    .bindings = {{"beauty", beauty}, {"disocclusion", disocclusion}, {"shown", shown}},
                    .params = gpu::paramsOf(params),
                    .constants = {},
                    .extent = extent});
    return shown;
}

}  // namespace

const ParamTable<TemporalSettings>& temporal::params() {
    static const auto table = [] {
        using S = TemporalSettings;
        ParamTable<S> t("temporal");
        t.add("normal", &S::normal, -1.0, 1.0, "cosine",
              "Minimum cosine between a previous pixel's normal and the expected one; higher keeps edges, "
              "lower keeps more history on curved surfaces")
            .slider(0.5, 1);
        t.add("depth", &S::depth, 0.0, 1e6, "of the distance",
              "Maximum deviation from the expected distance (world units without `relative`); lower ghosts "
              "less, higher loses less history")
            .slider(0, 1, SliderScale::Logarithmic, 0.001);
        t.add("relative", &S::relative,
              "Measure `depth` relative to the distance, and allow more on tilted planes");
        t.add("search", &S::search,
              "Search the 3x3 neighbouring pixels if all four bilinear taps are rejected");
        t.add("demodulate", &S::demodulate,
              "Divide by the albedo before resampling and multiply afterwards; keeps textures sharp");
        t.add("min_albedo", &S::minAlbedo, 1e-3, 1.0, "",
              "Minimum albedo that `demodulate` divides by; lower keeps the colours of dark surfaces apart, "
              "higher limits their noise")
            .slider(1e-3, 1, SliderScale::Logarithmic);
        t.add("max_history", &S::maxHistory, 0.0, 1e6, "frames",
              "Maximum number of frames that the history counts for; higher is smoother, lower follows "
              "changing light faster; below 1 counts as 1; 0 is no limit")
            .slider(0, 1000, SliderScale::Logarithmic, 1);
        t.add("grey_restart", &S::greyRestart,
              "Start pixels without history from a grey of weight 1; softens the black of new pixels");
        t.add("grey", &S::grey, 0.0, 1e6, "cd/m^2",
              "Brightness of the grey of `grey_restart`; higher is brighter")
            .slider(0, 2);
        t.add("grey_misses", &S::greyMisses, "Use `grey_restart` for pixels that hit nothing, too");
        t.add("identity", &S::identity,
              "Reject history of another object; off: objects that touch may share history");
        t.add("show_disocclusion", &S::showDisocclusion,
              "Show why pixels have no history: blue: nothing hit, yellow: off screen, red: no valid tap");
        return t;
    }();
    return table;
}

TemporalImages accumulateTemporally(gpu::FrameGraph& graph, const DenoiserInput& input,
                                    const TemporalSettings& settings) {
    using gpu::Format;
    const gpu::Extent extent = graph.extent(input.diffuse);
    const gpu::History color = graph.history("temporal/color", Format::RGBA32Float, extent);
    const gpu::History surfaces = recordSurfaces(graph, input);
    const bool buffers = input.filters == gpu::Backing::Buffer;
    const gpu::ImageHandle disocclusion = graph.transient("temporal/disocclusion", Format::R32Uint, extent);
    const TemporalParams params = makeParams(extent, input, settings);
    graph.dispatch(
        {.pass = "temporal/accumulate",
         .shader = buffers ? shaders::temporal_accumulate_buffers_comp : shaders::temporal_accumulate_comp,
         .bindings = {{"diffuse", input.diffuse},
                      {"specular", input.specular ? input.specular : input.diffuse},
                      {"albedo", input.albedo},
                      {"surfaces", surfaces.current},
                      {"motion", input.motion},
                      {"previousNormal", input.previousNormal ? input.previousNormal : input.motion},
                      {"surfacesBefore", surfaces.previous},
                      {"colorBefore", color.previous},
                      {"color", color.current},
                      {"disocclusion", disocclusion}},
         .params = gpu::paramsOf(params),
         .constants = {{"TWO_LIGHTS", input.specular ? 1u : 0u}, {"TURNS", input.previousNormal ? 1u : 0u}},
         .extent = extent});
    TemporalImages images{color.current, disocclusion, params.minAlbedo};
    if (input.reasons.wanted)
        images.reasons.push_back(recordReasons(graph, input, surfaces,
                                               {.method = "temporal",
                                                .signal = "joint",
                                                .tests = params.tests,
                                                .instances = settings.identity,
                                                .frames = color,
                                                .longest = params.maxHistory}));
    return images;
}

DisocclusionCounts countDisocclusion(std::span<const uint32_t> disocclusion) {
    DisocclusionCounts counts;
    for (const uint32_t value : disocclusion) {
        const uint32_t failure = value & DISOCCLUSION_MASK;
        counts.nothingHit += failure == DISOCCLUSION_NOTHING_HIT;
        counts.offScreen += failure == DISOCCLUSION_OFF_SCREEN;
        counts.noValidTap += failure == DISOCCLUSION_NO_VALID_TAP;
        counts.rejected += (value & SAMPLE_REJECTED) != 0;
    }
    return counts;
}

DenoiserOutput composeTemporal(gpu::FrameGraph& graph, const DenoiserInput& input,
                               const TemporalImages& accumulated, const FilterSettings& settings) {
    const gpu::ImageHandle beauty = compose(graph, "temporal/compose",
                                            {.light = accumulated.color,
                                             .albedo = input.albedo,
                                             .emission = input.emission,
                                             .target = input.target,
                                             .minAlbedo = accumulated.minAlbedo});
    const gpu::ImageHandle picture = settings.temporal.showDisocclusion
                                         ? showDisocclusion(graph, beauty, accumulated.disocclusion)
                                         : antialias(graph, input, beauty, settings.taa);
    return {picture, accumulated.disocclusion, accumulated.color, accumulated.reasons};
}

DenoiserOutput temporal::record(gpu::FrameGraph& graph, const DenoiserInput& input,
                                const FilterSettings& settings) {
    return composeTemporal(graph, input, accumulateTemporally(graph, input, settings.temporal), settings);
}

}  // namespace limpid::denoise
