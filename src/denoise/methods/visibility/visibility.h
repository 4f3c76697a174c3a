// Denoises visibility: one number from 0 to 1 for each pixel, such as ambient occlusion or a shadow mask. It
// follows the scheme of SVGF (C. Schied et al., HPG 2017) and shares its shaders, but filters one channel.
// Steps and formulas are in docs/denoising.md.
#pragma once

#include "denoise/methods/method.h"

namespace limpid::denoise {

/// User settings; visibility::params() gives ranges and descriptions.
struct VisibilitySettings {
    float alpha = 0.05f;
    float alphaFast = 0.5f;
    float normalTest = 0.95f;
    float depthTest = 0.02f;
    float antilag = 64.0f;
    float antilagNoise = 2.5f;
    int youngRadius = 4;
    int levels = 3;
    float phi = 4.0f;
    float phiNormal = 64.0f;
    float phiDepth = 2.0f;
    bool operator==(const VisibilitySettings&) const = default;
};

/// Records one frame. Visibility is the first component of `diffuse`, plus that of `emission` if there is
/// one, limited to 0 to 1; where `diffuse` is not finite, the sample is rejected. Where no surface is seen it
/// stays as it is. Returns rgba32f: it as grey, alpha 1. Passes: "surfaces", "visibility/accumulate",
/// "visibility/tiles", "visibility/lags" and "visibility/antilag" (none of them without anti-lag),
/// "visibility/level 1", "visibility/young" (unless it is off), "visibility/level 2" and so on, and for
/// debugging "visibility/reasons visibility". Histories: the surfaces, and "visibility/moments"
/// (svgf_moments.glsl).
DenoiserOutput filterVisibility(gpu::FrameGraph& graph, const DenoiserInput& input,
                                const VisibilitySettings& settings);

/// The entry in the list of methods (methods.h).
namespace visibility {
using Settings = VisibilitySettings;
inline constexpr std::string_view help =
    "one channel from 0 to 1, such as ambient occlusion or a shadow mask, in less time than colour";
inline constexpr std::array<std::string_view, 2> groups{"visibility", "taa"};
const ParamTable<Settings>& params();
inline constexpr bool readsLayers = false;
inline constexpr bool readsVariances = false;
inline constexpr bool oneChannel = true;
inline constexpr bool keepsHistory = true;
inline constexpr uint32_t samples = 1;
DenoiserOutput record(gpu::FrameGraph& graph, const DenoiserInput& input, const FilterSettings& settings);
}  // namespace visibility

}  // namespace limpid::denoise
