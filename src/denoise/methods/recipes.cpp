#include "denoise/methods/recipes.h"

#include "denoise/stages/compose/compose.h"

namespace limpid::denoise {
namespace {

DenoiserOutput composed(gpu::FrameGraph& graph, const DenoiserInput& input, const TemporalImages& accumulated,
                        const FilterSettings& settings) {
    const bool showDisocclusion = settings.temporal.showDisocclusion;
    const gpu::ImageHandle beauty =
        compose(graph, accumulated.color, input.emission, accumulated.disocclusion, showDisocclusion);
    return {showDisocclusion ? beauty : antialias(graph, input, beauty, settings.taa),
            accumulated.disocclusion};
}

}  // namespace

DenoiserOutput recordTemporal(gpu::FrameGraph& graph, const DenoiserInput& input,
                              const FilterSettings& settings) {
    return composed(graph, input, accumulateTemporally(graph, input, settings.temporal), settings);
}

DenoiserOutput recordAtrous(gpu::FrameGraph& graph, const DenoiserInput& input,
                            const FilterSettings& settings) {
    if (!settings.atrous.temporal)
        return {antialias(graph, input,
                          filterAtrous(graph, input, {input.diffuse, input.specular}, settings.atrous),
                          settings.taa),
                {}};
    const TemporalImages accumulated = accumulateTemporally(graph, input, settings.temporal);
    if (settings.temporal.showDisocclusion) return composed(graph, input, accumulated, settings);
    const gpu::ImageHandle filtered = filterAtrous(graph, input, {accumulated.color, {}}, settings.atrous);
    return {antialias(graph, input, filtered, settings.taa), accumulated.disocclusion};
}

DenoiserOutput recordSvgf(gpu::FrameGraph& graph, const DenoiserInput& input,
                          const FilterSettings& settings) {
    return {antialias(graph, input, filterSvgf(graph, input, settings.svgf), settings.taa), {}};
}

}  // namespace limpid::denoise
