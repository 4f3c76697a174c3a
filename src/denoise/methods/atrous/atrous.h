// The edge-avoiding a-trous filter: levels of a 5x5 B3 spline whose taps move apart, weighted by geometry.
// It filters light without albedo. docs/denoising.md has the formulas and the paper.
#pragma once

#include "denoise/methods/method.h"

namespace limpid::denoise {

/// User settings; atrous::params() gives ranges and descriptions.
struct AtrousSettings {
    bool temporal = true;
    int levels = 5;
    float normalFactor = 3e-4f;
    float depthFactor = 1e-4f;
    float sampleTarget = 32.0f;
    bool plane = true;
    bool demodulate = true;
    float minAlbedo = 0.05f;
    float colorFactor = 0.0f;
    bool operator==(const AtrousSettings&) const = default;
};

/// Scattered light: `first`, plus `second` if there is one.
struct AtrousLight {
    gpu::ImageHandle first, second;
    float minAlbedo = 0.0f;  ///< above 0: it is divided by the albedo already (TemporalImages)
    bool isMean = false;     ///< over frames, with their number in alpha of `first`
};

/// The filtered beauty, rgba32f, alpha 1: `light` filtered, plus the frame's emission. Passes:
/// "atrous/demodulate", "atrous/level 1" and so on, "atrous/compose".
gpu::ImageHandle filterAtrous(gpu::FrameGraph& graph, const DenoiserInput& input, const AtrousLight& light,
                              const AtrousSettings& settings);

/// The entry in the list of methods (methods.h).
namespace atrous {
using Settings = AtrousSettings;
inline constexpr std::string_view help = "temporal accumulation, then the edge-avoiding a-trous filter";
inline constexpr std::array<std::string_view, 3> groups{"temporal", "atrous", "taa"};
const ParamTable<Settings>& params();
inline constexpr bool readsLayers = true;
inline constexpr bool readsVariances = false;
inline constexpr bool oneChannel = false;
inline constexpr bool keepsHistory = true;
inline constexpr uint32_t samples = 1;
DenoiserOutput record(gpu::FrameGraph& graph, const DenoiserInput& input, const FilterSettings& settings);
}  // namespace atrous

}  // namespace limpid::denoise
