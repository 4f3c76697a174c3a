#include "denoise/methods/svgf/svgf_lags.h"

#include <algorithm>

#include "svgf_lags.comp.h"
#include "svgf_tiles.comp.h"

namespace limpid::denoise {
namespace {

/// The variance of (fast mean - slow mean) after a long history of steady light, as a share of the
/// variance of one frame's samples. 0 if the slow mean consists of one frame, because that variance is
/// then unknown.
float steadyShare(float slow, float fast) {
    const auto shrunk = [](float alpha) { return alpha / (2.0f - alpha); };
    const float common = fast * slow / (fast + slow - fast * slow);
    if (slow >= 1.0f) return 0.0f;
    return std::max((shrunk(fast) + shrunk(slow) - 2.0f * common) / (1.0f - shrunk(slow)), 0.0f);
}

}  // namespace

SvgfLagParams svgfLagParams(const SvgfLagSettings& settings) {
    return {steadyShare(settings.slow, settings.fast), settings.antilag, settings.noise, settings.pixel};
}

gpu::Extent tilesOf(gpu::Extent picture, uint32_t edge) {
    return {(picture.width + edge - 1) / edge, (picture.height + edge - 1) / edge};
}

void recordTileSums(gpu::FrameGraph& graph, const std::string& pass, gpu::ImageHandle moments,
                    gpu::ImageHandle tileSums, const SvgfLagParams& lag) {
    const gpu::Extent pixels = graph.extent(moments);
    const SvgfTileSumsParams params{pixels.width, pixels.height, lag};
    graph.dispatch({.pass = pass,
                    .shader = shaders::svgf_tiles_comp,
                    .bindings = {{"moments", moments}, {"tileSums", tileSums}},
                    .params = gpu::paramsOf(params),
                    .constants = {},
                    .extent = graph.extent(tileSums)});
}

void recordTileLags(gpu::FrameGraph& graph, const std::string& pass, gpu::ImageHandle tileSums,
                    gpu::ImageHandle tiles, const SvgfLagParams& lag, bool around) {
    const gpu::Extent extent = graph.extent(tiles);
    const SvgfTilesParams params{extent.width, extent.height, lag};
    graph.dispatch({.pass = pass,
                    .shader = shaders::svgf_lags_comp,
                    .bindings = {{"tileSums", tileSums}, {"tiles", tiles}},
                    .params = gpu::paramsOf(params),
                    .constants = {{"AROUND", around ? 1u : 0u}},
                    .extent = extent});
}

}  // namespace limpid::denoise
