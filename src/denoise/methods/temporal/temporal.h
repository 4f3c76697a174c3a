// Temporal accumulation: the running mean of a pixel's samples follows the surface point that it sees through
// camera and object motion. The steps, formulas and causes of disocclusion are in docs/denoising.md.
#pragma once

#include <span>

#include "denoise/methods/method.h"
#include "denoise/methods/temporal/temporal_params.h"

namespace limpid::denoise {

/// User settings; temporal::params() gives ranges and descriptions.
struct TemporalSettings {
    float normal = 0.95f;
    float depth = 0.02f;
    bool relative = true;
    bool search = true;
    bool demodulate = true;
    float minAlbedo = 0.02f;
    float maxHistory = 8.0f;
    bool greyRestart = false;
    float grey = 0.5f;
    bool greyMisses = false;
    bool identity = true;
    bool showDisocclusion = false;
    bool operator==(const TemporalSettings&) const = default;
};

struct TemporalImages {
    /// rgba32f: the mean of diffuse + specular, cd/m^2, divided by the albedo (modulation() in
    /// stages/guides.glsl with `minAlbedo`); the number of frames in it
    gpu::ImageHandle color;
    gpu::ImageHandle disocclusion;  ///< r32ui: DISOCCLUSION_* and SAMPLE_REJECTED of temporal_params.h
    float minAlbedo = 0.0f;         ///< 0: `color` contains the albedo
    std::vector<SignalReasons> reasons = {};  ///< DenoiserOutput::reasons
};

/// One frame. Passes: "surfaces", "temporal/accumulate", and for debugging "temporal/reasons joint". `color`
/// and the surfaces are histories of the graph: the pass reads those of the previous frame. They need no
/// clearing when the camera moves.
TemporalImages accumulateTemporally(gpu::FrameGraph& graph, const DenoiserInput& input,
                                    const TemporalSettings& settings);

/// How many pixels have no history, and why.
struct DisocclusionCounts {
    uint64_t nothingHit = 0, offScreen = 0, noValidTap = 0;
    uint64_t rejected = 0;  ///< samples that were NaN or infinite
};
/// Counts the pixels of the downloaded image `disocclusion`.
DisocclusionCounts countDisocclusion(std::span<const uint32_t> disocclusion);

/// The picture of the accumulated light; with `show_disocclusion`, the causes of missing history in colours.
DenoiserOutput composeTemporal(gpu::FrameGraph& graph, const DenoiserInput& input,
                               const TemporalImages& accumulated, const FilterSettings& settings);

/// The entry in the list of methods (methods.h).
namespace temporal {
using Settings = TemporalSettings;
inline constexpr std::string_view help =
    "each pixel's running mean follows its surface through camera and object motion";
inline constexpr std::array<std::string_view, 2> groups{"temporal", "taa"};
const ParamTable<Settings>& params();
inline constexpr bool readsLayers = false;
inline constexpr bool readsVariances = false;
inline constexpr bool oneChannel = false;
inline constexpr bool keepsHistory = true;
inline constexpr uint32_t samples = 1;
DenoiserOutput record(gpu::FrameGraph& graph, const DenoiserInput& input, const FilterSettings& settings);
}  // namespace temporal

}  // namespace limpid::denoise
