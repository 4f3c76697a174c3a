// Spatiotemporal variance-guided filtering: C. Schied et al., "Spatiotemporal Variance-Guided Filtering:
// Real-Time Reconstruction for Path-Traced Global Illumination", HPG 2017. The steps and formulas, and the
// additions to the paper are in docs/denoising.md.
#pragma once

#include "denoise/methods/method.h"

namespace limpid::denoise {

/// User settings; svgf::params() gives ranges and descriptions.
struct SvgfSettings {
    bool separate = true;
    bool demodulate = true;
    float minAlbedo = 0.01f;
    float alpha = 0.1f;
    float alphaMoments = 0.1f;
    float alphaFast = 0.5f;
    float normalTest = 0.95f;
    float depthTest = 0.02f;
    float lobeTest = 2.0f;
    bool relative = true;
    bool search = true;
    bool reflections = true;
    float antilag = 64.0f;
    float antilagNoise = 2.5f;
    float antilagPixel = 2.5f;
    bool antilagAround = true;
    float fireflies = 16.0f;
    int youngRadius = 4;
    float stabilisationAlpha = 0.5f;
    float stabilisationNoise = 0.5f;
    int levels = 4;
    int historyLevel = 0;
    bool wide = false;
    float phiColor = 4.0f;
    float phiNormal = 64.0f;
    float phiDepth = 3.0f;
    float phiRoughness = 0.1f;
    int blurLevels = 1;
    int meanLevels = 1;
    bool dampOutliers = true;
    bool boost = true;
    bool position = false;
    bool operator==(const SvgfSettings&) const = default;
};

/// Records one frame and returns the clean beauty, rgba32f, alpha 1. A pass with SIGNAL in its name runs once
/// for "joint", or for "diffuse" and "specular". Passes: "surfaces", "svgf/reproject SIGNAL",
/// "svgf/tiles SIGNAL" (with filters in images; otherwise "svgf/reproject" does its work), "svgf/lags SIGNAL"
/// and "svgf/antilag SIGNAL" (none of them without anti-lag), "svgf/variance SIGNAL", "svgf/level 1",
/// "svgf/young SIGNAL" (unless it is off), "svgf/level 2" and so on, "svgf/compose", and for debugging
/// "svgf/reasons SIGNAL". Histories: the surfaces, and for each signal "svgf/SIGNAL color",
/// "svgf/SIGNAL moments" and "svgf/SIGNAL stable".
gpu::ImageHandle filterSvgf(gpu::FrameGraph& graph, const DenoiserInput& input, const SvgfSettings& settings);

/// The same, and each filtered signal: rgba32f, with albedo, without emission, alpha 1.
struct SvgfImages {
    gpu::ImageHandle beauty;
    gpu::ImageHandle diffuse;                 ///< without `separate`: all light that was filtered
    gpu::ImageHandle specular;                ///< empty without `separate`
    gpu::ImageHandle moments;                 ///< of diffuse light, or of all: svgf_moments.glsl
    std::vector<SignalReasons> reasons = {};  ///< DenoiserOutput::reasons
};
SvgfImages filterSvgfSignals(gpu::FrameGraph& graph, const DenoiserInput& input,
                             const SvgfSettings& settings);

/// The entry in the list of methods (methods.h).
namespace svgf {
using Settings = SvgfSettings;
inline constexpr std::string_view help =
    "spatiotemporal variance-guided filtering: blurs where and as much as there is noise";
inline constexpr std::array<std::string_view, 2> groups{"svgf", "taa"};
const ParamTable<Settings>& params();
inline constexpr bool readsLayers = false;
inline constexpr bool oneChannel = false;
inline constexpr bool keepsHistory = true;
DenoiserOutput record(gpu::FrameGraph& graph, const DenoiserInput& input, const FilterSettings& settings);
}  // namespace svgf

}  // namespace limpid::denoise
