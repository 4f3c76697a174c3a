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
    bool sampleVariance = true;
    bool position = false;
    bool operator==(const SvgfSettings&) const = default;
};

/// What the steps made of one signal, for a method that goes on from there. RGBA16Float, light without
/// albedo.
struct SvgfSignalStages {
    gpu::ImageHandle accumulated;  ///< and the deviation of its luminance
    gpu::ImageHandle moments;      ///< svgf_moments.glsl; the fourth component counts frames
    gpu::ImageHandle first;        ///< after the first level of the filter
    gpu::ImageHandle past;         ///< R32Uint, svgf_stable.glsl: the stabilised light of before, where it is
                                   ///< now; one pixel without stabilisation
    gpu::ImageHandle stable;       ///< likewise, for the next frame: a method may replace it by its own light
    gpu::ImageHandle filtered;     ///< after the last level
};
struct SvgfStages {
    gpu::ImageHandle surfaces;              ///< surface_texel.glsl
    std::vector<SvgfSignalStages> signals;  ///< diffuse and specular, or with `separate` off their sum
    bool stabilised = false;                ///< `past` and `stable` have been written
    std::vector<SignalReasons> reasons;     ///< DenoiserOutput::reasons
};
/// All passes of svgf::record() but the last ones.
SvgfStages recordSvgfStages(gpu::FrameGraph& graph, const DenoiserInput& input, const SvgfSettings& settings);

/// Light of the signals, as SvgfStages::signals have it; the second is not read without `separate`.
using SvgfLight = std::array<gpu::ImageHandle, 2>;

/// The last passes, with `light` in the place of SvgfSignalStages::filtered.
DenoiserOutput composeSvgf(gpu::FrameGraph& graph, const DenoiserInput& input, const FilterSettings& settings,
                           const SvgfStages& stages, const SvgfLight& light);

/// The entry in the list of methods (methods.h). A pass with SIGNAL in its name runs once for "joint", or for
/// "diffuse" and "specular". Passes: "surfaces", "svgf/reproject SIGNAL", "svgf/tiles SIGNAL" (with filters
/// in images; otherwise "svgf/reproject" does its work), "svgf/lags SIGNAL" and "svgf/antilag SIGNAL" (none
/// of them without anti-lag), "svgf/variance SIGNAL", "svgf/level 1", "svgf/young SIGNAL" (unless it is off),
/// "svgf/level 2" and so on, for debugging "svgf/reasons SIGNAL", "svgf/compose", where signals are wanted
/// "svgf/compose diffuse" and "svgf/compose specular", and "taa". Histories: the surfaces, and for each
/// signal "svgf/SIGNAL color", "svgf/SIGNAL moments" and "svgf/SIGNAL stable".
namespace svgf {
using Settings = SvgfSettings;
inline constexpr std::string_view help =
    "spatiotemporal variance-guided filtering: blurs where and as much as there is noise";
inline constexpr std::array<std::string_view, 2> groups{"svgf", "taa"};
const ParamTable<Settings>& params();
inline constexpr bool readsLayers = false;
inline constexpr bool readsVariances = true;
inline constexpr bool oneChannel = false;
inline constexpr bool keepsHistory = true;
inline constexpr uint32_t samples = 1;
DenoiserOutput record(gpu::FrameGraph& graph, const DenoiserInput& input, const FilterSettings& settings);
}  // namespace svgf

}  // namespace limpid::denoise
