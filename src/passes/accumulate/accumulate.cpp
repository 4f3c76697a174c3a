#include "passes/accumulate/accumulate.h"

#include "accumulate.comp.h"
#include "passes/accumulate/accumulate_params.h"

namespace limpid {
namespace {

vec3 varianceWeights(VarianceOf varianceOf) {
    switch (varianceOf) {
        case VarianceOf::Luminance:
            return {0.2126f, 0.7152f, 0.0722f};
        case VarianceOf::FirstComponent:
            return {1.0f, 0.0f, 0.0f};
        case VarianceOf::MeanOfComponents:
        case VarianceOf::Nothing:
            break;
    }
    return vec3(0.0f);
}

}  // namespace

void accumulateStep(gpu::FrameGraph& graph, const std::string& name, const AccumulateStep& step) {
    const gpu::Extent extent = graph.extent(step.added);
    AccumulateParams params{};
    params.width = extent.width;
    params.height = extent.height;
    params.countBefore = step.countBefore;
    params.countAdded = step.countAdded;
    params.weights = varianceWeights(step.varianceOf);
    params.perComponent = step.varianceOf == VarianceOf::MeanOfComponents ? 1u : 0u;
    graph.dispatch({.pass = "accumulate/" + name,
                    .shader = shaders::accumulate_comp,
                    .bindings = {{"added", step.added}, {"before", step.before}, {"after", step.after}},
                    .params = gpu::paramsOf(params),
                    .constants = {},
                    .extent = extent});
}

gpu::ImageHandle accumulate(gpu::FrameGraph& graph, const std::string& name, gpu::ImageHandle added,
                            uint64_t countBefore, uint32_t countAdded, VarianceOf varianceOf) {
    const gpu::History history =
        graph.history("accumulate/" + name, gpu::Format::RGBA32Float, graph.extent(added));
    accumulateStep(graph, name,
                   {.before = history.previous,
                    .added = added,
                    .after = history.current,
                    .countBefore = history.valid ? static_cast<float>(countBefore) : 0.0f,
                    .countAdded = static_cast<float>(countAdded),
                    .varianceOf = varianceOf});
    return history.current;
}

}  // namespace limpid
