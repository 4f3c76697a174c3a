// How far the slow mean of a signal lags behind the fast mean, by tiles: the passes of anti-lag
// (docs/denoising.md, SVGF, step 4) for every method whose moments are stored as in svgf_moments.glsl.
#pragma once

#include <string>

#include "denoise/methods/svgf/svgf_params.h"
#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

struct SvgfLagSettings {
    float slow, fast;             ///< minimum weights of a new frame in the two means
    float antilag, noise, pixel;  ///< SvgfSettings::antilag and so on
};
SvgfLagParams svgfLagParams(const SvgfLagSettings& settings);

/// The number of tiles, `edge` pixels long and high, that cover a picture.
gpu::Extent tilesOf(gpu::Extent picture, uint32_t edge);

/// Writes `tileSums` (rgba32f, tiles of SVGF_TILE pixels, svgf_tiles.glsl).
void recordTileSums(gpu::FrameGraph& graph, const std::string& pass, gpu::ImageHandle moments,
                    gpu::ImageHandle tileSums, const SvgfLagParams& lag);

/// Writes the lag of each tile (r32f). `around`: of the 3x3 tiles around it together.
void recordTileLags(gpu::FrameGraph& graph, const std::string& pass, gpu::ImageHandle tileSums,
                    gpu::ImageHandle tiles, const SvgfLagParams& lag, bool around);

}  // namespace limpid::denoise
