#include "denoise/api/denoiser.h"

#include <algorithm>
#include <array>

#include "denoise/stages/compose/compose.h"

namespace limpid::denoise {
namespace {

DenoiserOutput composed(gpu::FrameGraph& graph, const DenoiserInput& input, const HistoryImages& history,
                        const DenoiserSettings& settings) {
    const bool showCases = settings.history.showCases;
    const gpu::ImageHandle beauty = compose(graph, history.color, input.emission, history.cases, showCases);
    return {showCases ? beauty : antialias(graph, input, beauty, settings.taa), history.cases};
}

DenoiserOutput recordHistory(gpu::FrameGraph& graph, const DenoiserInput& input,
                             const DenoiserSettings& settings) {
    return composed(graph, input, trackHistory(graph, input, settings.history), settings);
}

DenoiserOutput recordAtrous(gpu::FrameGraph& graph, const DenoiserInput& input,
                            const DenoiserSettings& settings) {
    if (!settings.atrous.history)
        return {antialias(graph, input,
                          filterAtrous(graph, input, {input.diffuse, input.specular}, settings.atrous),
                          settings.taa),
                {}};
    const HistoryImages history = trackHistory(graph, input, settings.history);
    if (settings.history.showCases) return composed(graph, input, history, settings);
    const gpu::ImageHandle filtered = filterAtrous(graph, input, {history.color, {}}, settings.atrous);
    return {antialias(graph, input, filtered, settings.taa), history.cases};
}

DenoiserOutput recordSvgf(gpu::FrameGraph& graph, const DenoiserInput& input,
                          const DenoiserSettings& settings) {
    return {antialias(graph, input, filterSvgf(graph, input, settings.svgf), settings.taa), {}};
}

DenoiserOutput recordKpcn(gpu::FrameGraph& graph, const DenoiserInput& input,
                          const DenoiserSettings& settings) {
    return {antialias(graph, input, filterKpcn(graph, input, settings.kpcn), settings.taa), {}};
}

constexpr std::array<std::string_view, 2> historyGroups{"history", "taa"};
constexpr std::array<std::string_view, 3> atrousGroups{"history", "atrous", "taa"};
constexpr std::array<std::string_view, 2> svgfGroups{"svgf", "taa"};

constexpr std::array<std::string_view, 2> kpcnGroups{"kpcn", "taa"};

constexpr std::array<Denoiser, 4> all{
    Denoiser{"history", "each pixel's running mean follows its surface through camera and object motion",
             recordHistory, historyGroups, 8.0},
    Denoiser{"atrous", "history, then the edge-avoiding a-trous filter", recordAtrous, atrousGroups, 8.0},
    Denoiser{"svgf", "spatiotemporal variance-guided filtering: blurs where and as much as there is noise",
             recordSvgf, svgfGroups, 8.0},
    Denoiser{"kpcn", "kernels predicted by a trained network: each frame by itself, of some 32 samples",
             recordKpcn, kpcnGroups, 8.0, true}};

}  // namespace

std::span<const Denoiser> denoisers() {
    return all;
}

const Denoiser* findDenoiser(std::string_view name) {
    const auto found = std::ranges::find(all, name, &Denoiser::name);
    return found == all.end() ? nullptr : &*found;
}

}  // namespace limpid::denoise
