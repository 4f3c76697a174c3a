// History tracking: the running mean of a pixel's samples follows the surface point that it sees through
// camera and object motion. The steps, formulas and failure cases are in docs/denoising.md.
#pragma once

#include <span>

#include "base/params.h"
#include "denoise/api/denoiser_input.h"
#include "denoise/methods/history/history_params.h"
#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

/// What a user may set; historyParams() is where range and meaning stand.
struct HistorySettings {
    float normal = 0.95f;
    float depth = 0.02f;
    bool relative = true;
    bool search = true;
    bool demodulate = true;
    float maxHistory = 8.0f;
    bool greyRestart = false;
    float grey = 0.5f;
    bool greyMisses = false;
    bool identity = true;
    bool showCases = false;
    bool operator==(const HistorySettings&) const = default;
};
const ParamTable<HistorySettings>& historyParams();

struct HistoryImages {
    gpu::ImageHandle color;        ///< rgba32f: mean of diffuse + specular, cd/m^2; number of frames in it
    gpu::ImageHandle normalDepth;  ///< rgba32f: world normal, distance from the eye (0: nothing seen)
    gpu::ImageHandle albedoId;     ///< rgba32f: albedo, instance number + 1
    gpu::ImageHandle cases;        ///< r32ui: CASE_* and SAMPLE_REJECTED of history_params.h
};

/// One frame. The three images besides `cases` are histories of the graph ("history/color",
/// "history/normal_depth", "history/albedo_id"): what they held in the previous frame is read, and nothing
/// needs clearing when the camera moves.
HistoryImages trackHistory(gpu::FrameGraph& graph, const DenoiserInput& input,
                           const HistorySettings& settings);

/// How many pixels have no history, and why.
struct HistoryCounts {
    uint64_t nothingHit = 0, offScreen = 0, noValidTap = 0;
    uint64_t rejected = 0;  ///< samples that were NaN or infinite
};
/// Of the image `cases`, as downloaded.
HistoryCounts countCases(std::span<const uint32_t> cases);

}  // namespace limpid::denoise
