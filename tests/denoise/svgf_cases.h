// Scenes and settings with which every pass of SVGF is compared.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "renderer/method/presets.h"
#include "tests/denoise/denoise_fixture.h"

namespace limpid::test {

using denoise::SvgfSettings;

struct SvgfCase {
    const char* name;
    SyntheticOptions options;
    SvgfSettings settings;
    uint32_t columns = 101, rows = 57;
    int frames = 8;
    int resizeAt = -1;     ///< from this frame on the picture is smaller
    int jumpAt = -1;       ///< from this frame on the light is three times as bright
    bool hasNans = false;  ///< and infinities, in radiance, albedo and roughness
    bool hasRoughness = true;
    int mixesFrom = 0;          ///< before this frame, filtered light is not stabilised
    bool hasNegatives = false;  ///< a quarter of the light is 0, a quarter below 0
    uint32_t samples = 1;       ///< with known variances, if there are more
    float brightness = 1.0f;    ///< the light's factor
};

inline SvgfSettings svgfPreset(const char* name) {
    RenderSettings settings;
    applyPreset(settings, name);
    return settings.denoisers.svgf;
}

inline std::vector<SvgfCase> svgfCases() {
    constexpr SyntheticOptions moving{.cameraMoves = true, .objectMoves = true};
    return {
        SvgfCase{"Static", {}, {}},
        SvgfCase{"Camera", {.cameraMoves = true}, {}},
        SvgfCase{"Object", {.objectMoves = true}, {}},
        SvgfCase{"Both", moving, {}},
        SvgfCase{"Orthographic", {.cameraMoves = true, .objectMoves = true, .orthographic = true}, {}},
        SvgfCase{"LargeScale", {.cameraMoves = true, .objectMoves = true, .scale = 1024}, {}},
        SvgfCase{.name = "Resize", .options = moving, .settings = {}, .resizeAt = 4},
        SvgfCase{"Tiny", moving, {}, 3, 2},
        SvgfCase{"Thin", {}, {}, 1, 40},
        SvgfCase{"Position",
                 moving,
                 {.historyLevel = 2, .phiNormal = 0.3f, .phiDepth = 0.5f, .blurLevels = 0, .position = true}},
        SvgfCase{"PositionOrthographic",
                 {.cameraMoves = true, .orthographic = true},
                 {.levels = 2, .historyLevel = 5, .phiNormal = 0.3f, .phiDepth = 0.5f, .position = true}},
        SvgfCase{"Cis565", moving, svgfPreset("svgf-cis565")},
        SvgfCase{"Paper", moving, svgfPreset("svgf-paper")},
        SvgfCase{"Fireflies", moving, {.fireflies = 0.2f, .levels = 2}},
        SvgfCase{"NoFireflies", moving, {.fireflies = 0.0f, .levels = 2}},
        SvgfCase{"WideFill", moving, {.youngRadius = 7, .levels = 2, .historyLevel = 1}},
        SvgfCase{"NoFill", moving, {.youngRadius = 0, .levels = 2}},
        SvgfCase{"ThreeLevels", moving, {.levels = 3}},
        SvgfCase{"Wide", moving, {.wide = true}},
        SvgfCase{"NarrowLobes", moving, {.lobeTest = 1.0f, .phiRoughness = 0.03f}},
        SvgfCase{.name = "NoRoughness", .options = moving, .settings = {.levels = 2}, .hasRoughness = false},
        SvgfCase{"NoLobes", moving, {.lobeTest = 0.0f, .levels = 2, .phiRoughness = 0.0f}},
        SvgfCase{"DarkAlbedo", moving, {.minAlbedo = 0.1f}},
        SvgfCase{"Modulated", moving, {.demodulate = false, .levels = 3, .historyLevel = 0}},
        SvgfCase{"NoLevels", moving, {.depthTest = 0.2f, .relative = false, .search = false, .levels = 0}},
        SvgfCase{"Slow", moving, {.alpha = 0.05f, .alphaMoments = 0.1f, .alphaFast = 0.3f, .levels = 1}},
        SvgfCase{"Fast", moving, {.alpha = 0.6f, .alphaMoments = 0.5f, .alphaFast = 0.9f, .levels = 1}},
        SvgfCase{"Noiseless", {.cameraMoves = true, .noise = false}, {}},
        SvgfCase{"NoReflections", moving, {.reflections = false, .levels = 1}},
        SvgfCase{"NotStabilised", moving, {.stabilisationAlpha = 1.0f, .levels = 2}},
        SvgfCase{
            "StabilisedAndFedBack", moving, {.stabilisationNoise = 2.0f, .levels = 2, .historyLevel = 2}},
        SvgfCase{.name = "MixedLater",
                 .options = moving,
                 .settings = {.stabilisationNoise = 9.0f, .levels = 1},
                 .mixesFrom = 3},
        SvgfCase{"OwnLuminance", moving, {.levels = 3, .meanLevels = 0}},
        SvgfCase{"MeanLuminances", moving, {.levels = 3, .wide = true, .meanLevels = 2}},
        SvgfCase{"OutliersKept", moving, {.levels = 3, .dampOutliers = false}},
        SvgfCase{"NoBoost", moving, {.levels = 2, .boost = false}},
        SvgfCase{.name = "Lag", .options = moving, .settings = {.levels = 2}, .frames = 10, .jumpAt = 6},
        SvgfCase{.name = "StaticLag", .options = {}, .settings = {.levels = 2}, .frames = 10, .jumpAt = 6},
        SvgfCase{.name = "LittleLag",
                 .options = moving,
                 .settings = {.antilag = 0.09f, .levels = 1},
                 .frames = 10,
                 .jumpAt = 6},
        SvgfCase{.name = "EqualMeans",
                 .options = moving,
                 .settings = {.alphaMoments = 0.3f, .alphaFast = 0.3f, .levels = 1},
                 .frames = 6},
        SvgfCase{.name = "NoSlowMean", .options = moving, .settings = {.alphaMoments = 1.0f, .levels = 1}},
        SvgfCase{.name = "Nans",
                 .options = moving,
                 .settings = {.levels = 3},
                 .frames = 10,
                 .jumpAt = 6,
                 .hasNans = true},
        SvgfCase{.name = "TwoSamples",
                 .options = moving,
                 .settings = {.fireflies = 0.2f, .levels = 2},
                 .samples = 2},
        SvgfCase{.name = "ManySamples",
                 .options = moving,
                 .settings = {.fireflies = 0.001f, .levels = 2},
                 .frames = 10,
                 .jumpAt = 6,
                 .hasNans = true,
                 .samples = 16},
        SvgfCase{.name = "BrightSamples",
                 .options = moving,
                 .settings = {.levels = 1},
                 .frames = 3,
                 .samples = 4,
                 .brightness = 1000.0f},
        SvgfCase{.name = "UnusedVariances",
                 .options = moving,
                 .settings = {.levels = 2, .sampleVariance = false},
                 .samples = 4},
        SvgfCase{.name = "SampledNegatives",
                 .options = moving,
                 .settings = {.levels = 0},
                 .hasNegatives = true,
                 .samples = 4},
        SvgfCase{.name = "Negatives", .options = moving, .settings = {.levels = 0}, .hasNegatives = true}};
}

/// Filters in buffers differ in where they load and store: cases of sizes, histories and tiles tell.
inline std::vector<SvgfCase> svgfCasesInBuffers() {
    const std::set<std::string> names{"Both", "Orthographic",  "Resize",    "Tiny",
                                      "Thin", "Position",      "Wide",      "Lag",
                                      "Nans", "NotStabilised", "Fireflies", "TwoSamples"};
    std::vector<SvgfCase> chosen;
    std::ranges::copy_if(svgfCases(), std::back_inserter(chosen),
                         [&](const SvgfCase& c) { return names.contains(c.name); });
    return chosen;
}

}  // namespace limpid::test
