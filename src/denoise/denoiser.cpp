#include "denoise/denoiser.h"

#include <algorithm>
#include <array>

#include "denoise/compose/compose.h"

namespace limpid::denoise {
namespace {

DenoiserOutput composed(gpu::FrameGraph& graph, const DenoiserInput& input, const HistoryImages& history,
                        const DenoiserSettings& settings) {
    return {compose(graph, history.color, input.emission, history.cases, settings.history.showCases),
            history.cases};
}

DenoiserOutput recordHistory(gpu::FrameGraph& graph, const DenoiserInput& input,
                             const DenoiserSettings& settings) {
    return composed(graph, input, trackHistory(graph, input, settings.history), settings);
}

DenoiserOutput recordAtrous(gpu::FrameGraph& graph, const DenoiserInput& input,
                            const DenoiserSettings& settings) {
    if (!settings.atrous.history)
        return {filterAtrous(graph, input, {input.diffuse, input.specular}, settings.atrous), {}};
    const HistoryImages history = trackHistory(graph, input, settings.history);
    if (settings.history.showCases) return composed(graph, input, history, settings);
    return {filterAtrous(graph, input, {history.color, {}}, settings.atrous), history.cases};
}

DenoiserOutput recordSvgf(gpu::FrameGraph& graph, const DenoiserInput& input,
                          const DenoiserSettings& settings) {
    return {filterSvgf(graph, input, settings.svgf), {}};
}

constexpr std::array<std::string_view, 1> historyGroups{"history"};
constexpr std::array<std::string_view, 2> atrousGroups{"history", "atrous"};

constexpr std::array<std::string_view, 1> svgfGroups{"svgf"};

constexpr std::array<Denoiser, 3> all{
    Denoiser{"history", "each pixel's running mean follows its surface through camera and object motion",
             recordHistory, historyGroups, 8.0},
    Denoiser{"atrous", "history, then the edge-avoiding a-trous filter", recordAtrous, atrousGroups, 8.0},
    Denoiser{"svgf", "spatiotemporal variance-guided filtering: blurs where and as much as there is noise",
             recordSvgf, svgfGroups, 8.0}};

}  // namespace

std::span<const Denoiser> denoisers() {
    return all;
}

const Denoiser* findDenoiser(std::string_view name) {
    const auto found = std::ranges::find(all, name, &Denoiser::name);
    return found == all.end() ? nullptr : &*found;
}

}  // namespace limpid::denoise
