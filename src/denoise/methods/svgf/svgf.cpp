#include "denoise/methods/svgf/svgf.h"

#include <algorithm>
#include <string>

#include "denoise/methods/methods.h"
#include "denoise/methods/svgf/svgf_lags.h"
#include "denoise/methods/svgf/svgf_params.h"
#include "denoise/stages/atrous/levels.h"
#include "denoise/stages/compose/compose.h"
#include "denoise/stages/surfaces/surfaces.h"
#include "svgf_antilag.comp.h"
#include "svgf_antilag_buffers.comp.h"
#include "svgf_last_level.comp.h"
#include "svgf_last_level_buffers.comp.h"
#include "svgf_level.comp.h"
#include "svgf_level_buffers.comp.h"
#include "svgf_reproject.comp.h"
#include "svgf_reproject_buffers.comp.h"
#include "svgf_variance.comp.h"
#include "svgf_variance_buffers.comp.h"
#include "svgf_young.comp.h"
#include "svgf_young_buffers.comp.h"

namespace limpid::denoise {
namespace {

using gpu::Backing;
using gpu::Extent;
using gpu::Format;
using gpu::FrameGraph;
using gpu::History;
using gpu::ImageHandle;

/// The shaders take powers of 2.
constexpr float log2e = 1.44269504f;

/// Light that is filtered separately: `light` plus `otherLight`, reflected by `albedo` plus `otherAlbedo`, if
/// there are others.
struct Signal {
    std::string name;
    ImageHandle light, albedo, otherLight, otherAlbedo;
    bool specular = false;
    bool reflects = false;
};

struct Accumulated {
    ImageHandle color;       ///< half4: light, expected deviation of its luminance or a mark (svgf_params.h)
    ImageHandle moments;     ///< half4: see svgf_moments.glsl
    ImageHandle tileSums;    ///< rgba32f: see svgf_tiles.glsl
    ImageHandle tiles;       ///< r32f: lag
    ImageHandle youngTiles;  ///< r32f: number of young pixels; only with buffers
    History feedback;        ///< of colors; `current` is what the next frame reads
    History stable;          ///< r32ui, svgf_stable.glsl: light of the last level
    ImageHandle stablePast;  ///< r32ui: stable light of before, where it is now
    History momentsKept;     ///< `current` is `moments`
};

class Svgf {
  public:
    Svgf(FrameGraph& graph, const DenoiserInput& input, const SvgfSettings& settings)
        : graph_(graph),
          input_(input),
          settings_(settings),
          extent_(graph.extent(input.diffuse)),
          buffers_(input.filters == Backing::Buffer) {}

    /// Records each pass for all signals before the next pass. Passes of one kind do not wait for each other,
    /// so the device fills up with the second while the first one ends.
    SvgfStages record() {
        const History surfaces = recordSurfaces(graph_, input_);
        const std::vector<Signal> all = signals();
        std::vector<Accumulated> accumulated;
        for (const Signal& signal : all) accumulated.push_back(reproject(signal, surfaces));
        if (settings_.antilag > 0.0f) followChanges(all, accumulated);
        std::vector<ImageHandle> filtered;
        for (size_t i = 0; i < all.size(); ++i) {
            estimateVariance(all[i], surfaces, accumulated[i]);
            filtered.push_back(accumulated[i].color);
        }
        std::vector<ImageHandle> first = filtered;
        for (int number = 1; number <= settings_.levels; ++number) {
            filtered = level(all, surfaces, accumulated, filtered, number);
            if (number > 1) continue;
            first = filtered;
            for (size_t i = 0; i < all.size() && fillsYoung(); ++i)
                fillYoung(all[i], surfaces, accumulated[i], filtered[i]);
        }
        SvgfStages stages{
            .surfaces = surfaces.current, .signals = {}, .stabilised = stabilises(), .reasons = {}};
        for (size_t i = 0; i < all.size(); ++i) {
            const Accumulated& a = accumulated[i];
            stages.signals.push_back(
                {a.color, a.moments, first[i], a.stablePast, a.stable.current, filtered[i]});
            if (input_.reasons.wanted) stages.reasons.push_back(reasons(all[i], surfaces, a));
        }
        return stages;
    }

    /// The picture.
    ImageHandle beautyOf(const SvgfLight& light) {
        return compose(graph_, "svgf/compose",
                       {.light = light[0],
                        .albedo = input_.albedo,
                        .second = settings_.separate ? light[1] : ImageHandle{},
                        .secondAlbedo = input_.albedoSpecular,
                        .emission = input_.emission,
                        .target = input_.target,
                        .minAlbedo = minAlbedo()});
    }

    /// Adds the signals to the output.
    void addSignals(const SvgfLight& light, DenoiserOutput& output) {
        if (settings_.separate) {
            output.diffuse = radianceOf("diffuse", light[0], input_.albedo);
            output.specular = radianceOf("specular", light[1], input_.albedoSpecular);
        } else {
            output.diffuse = radianceOf("diffuse", light[0], input_.albedo, input_.albedoSpecular);
        }
    }

  private:
    std::vector<Signal> signals() const {
        if (!settings_.separate)
            return {{"joint", input_.diffuse, input_.albedo, input_.specular, input_.albedoSpecular}};
        const bool reflects = settings_.reflections && input_.reflectionMotion;
        return {{.name = "diffuse", .light = input_.diffuse, .albedo = input_.albedo},
                {.name = "specular",
                 .light = input_.specular,
                 .albedo = input_.albedoSpecular,
                 .specular = true,
                 .reflects = reflects}};
    }

    const gpu::ShaderCode& choose(const gpu::ShaderCode& images, const gpu::ShaderCode& buffers) const {
        return buffers_ ? buffers : images;
    }

    bool hasRoughness(const Signal& signal) const { return signal.specular && input_.roughness; }

    float minAlbedo() const { return settings_.demodulate ? settings_.minAlbedo : 0.0f; }

    /// Per pixel and frame; 1 where their variance is unknown or not used.
    float samples() const {
        return input_.variances && settings_.sampleVariance ? static_cast<float>(std::max(input_.samples, 1u))
                                                            : 1.0f;
    }

    /// Converts a mean squared deviation to the variance of the mean.
    float ofMean() const { return samples() > 1.0f ? 1.0f / (samples() - 1.0f) : 0.0f; }

    /// The number of the level whose result is fed back; 0: no level's.
    int fedBack() const { return std::min(settings_.historyLevel, settings_.levels); }

    SvgfLagParams lagParams() const {
        return svgfLagParams({.slow = settings_.alphaMoments,
                              .fast = settings_.alphaFast,
                              .antilag = settings_.antilag,
                              .noise = settings_.antilagNoise,
                              .pixel = settings_.antilagPixel});
    }

    SvgfReprojectParams reprojectParams() const {
        SvgfReprojectParams params{};
        params.camera = input_.camera;
        params.width = extent_.width;
        params.height = extent_.height;
        params.tests = {.normal = settings_.normalTest,
                        .depth = settings_.depthTest,
                        .relative = settings_.relative,
                        .search = settings_.search,
                        .previousNormals = input_.normalEncoding,
                        .motion = input_.motionEncoding};
        params.minAlbedo = minAlbedo();
        params.ofMean = ofMean();
        params.lobeScale = 8.0f * log2e / std::max(settings_.lobeTest * settings_.lobeTest, 1e-12f);
        params.alpha = settings_.alpha;
        params.alphaMoments = settings_.alphaMoments;
        params.alphaFast = settings_.alphaFast;
        params.lag = lagParams();
        // With a shorter limit, all pixels would stay young for ever.
        params.longest = std::max(SVGF_YOUNG, 1.0f / std::min(settings_.alpha, settings_.alphaMoments));
        return params;
    }

    /// The last of the filter's levels does.
    bool stabilises() const { return settings_.stabilisationAlpha < 1.0f && settings_.levels > 0; }

    /// Adds the images that svgf_signal.glsl declares.
    static std::vector<gpu::Binding> withLight(const Signal& signal, std::vector<gpu::Binding> others) {
        others.insert(others.end(), {{"lightA", signal.light},
                                     {"lightB", signal.otherLight ? signal.otherLight : signal.light},
                                     {"albedoA", signal.albedo},
                                     {"albedoB", signal.otherAlbedo ? signal.otherAlbedo : signal.albedo}});
        return others;
    }

    std::vector<gpu::ConstantValue> constantsOf(const Signal& signal) const {
        return {{"TWO_LIGHTS", signal.otherLight ? 1u : 0u},
                {"TWO_ALBEDOS", signal.otherAlbedo ? 1u : 0u},
                {"BOOST", settings_.boost ? 1u : 0u}};
    }

    Accumulated reproject(const Signal& signal, const History& surfaces) {
        const std::string name = "svgf/" + signal.name;
        const Extent tileExtent = tilesOf(extent_, SVGF_TILE);
        const History feedback =
            graph_.history(name + " color", Format::RGBA16Float, extent_, input_.filters);
        const History moments = graph_.history(name + " moments", Format::RGBA16Float, extent_);
        const ImageHandle tileSums = graph_.transient(name + " tile sums", Format::RGBA32Float, tileExtent);
        const ImageHandle tiles = graph_.transient(name + " tiles", Format::R32Float, tileExtent);
        const Extent stableExtent = stabilises() ? extent_ : Extent{1, 1};
        const History stable =
            graph_.history(name + " stable", Format::R32Uint, stableExtent, input_.filters);
        const ImageHandle stablePast =
            graph_.transient(name + " stable past", Format::R32Uint, stableExtent, input_.filters);
        const ImageHandle color =
            fedBack() == 0
                ? feedback.current
                : graph_.transient(name + " accumulated", Format::RGBA16Float, extent_, input_.filters);
        const SvgfReprojectParams params = reprojectParams();
        std::vector<gpu::Binding> bindings{
            {"motion", input_.motion},
            {"reflectionMotion", signal.reflects ? input_.reflectionMotion : input_.motion},
            {"previousNormal", input_.previousNormal ? input_.previousNormal : input_.motion},
            {"surfaces", surfaces.current},
            {"surfacesBefore", surfaces.previous},
            {"colorBefore", feedback.previous},
            {"momentsBefore", moments.previous},
            {"color", color},
            {"moments", moments.current},
            {"stableBefore", stable.previous},
            {"stablePast", stablePast}};
        std::vector<gpu::ConstantValue> constants = constantsOf(signal);
        constants.push_back({"REFLECTIONS", signal.reflects ? 1u : 0u});
        constants.push_back({"STABILISE", stabilises() ? 1u : 0u});
        constants.push_back({"LOBES", hasRoughness(signal) && settings_.lobeTest > 0.0f ? 1u : 0u});
        constants.push_back({"TURNS", input_.previousNormal ? 1u : 0u});
        if (buffers_) {
            bindings.push_back({"tileSums", tileSums});
            constants.push_back({"TILES", settings_.antilag > 0.0f ? 1u : 0u});
        }
        graph_.dispatch({.pass = "svgf/reproject " + signal.name,
                         .shader = choose(shaders::svgf_reproject_comp, shaders::svgf_reproject_buffers_comp),
                         .bindings = withLight(signal, bindings),
                         .params = gpu::paramsOf(params),
                         .constants = constants,
                         .extent = extent_});
        const ImageHandle youngTiles = buffers_ ? graph_.transient(name + " young tiles", Format::R32Float,
                                                                   tilesOf(extent_, SVGF_YOUNG_TILE))
                                                : ImageHandle{};
        return {color, moments.current, tileSums, tiles, youngTiles, feedback, stable, stablePast, moments};
    }

    SignalReasons reasons(const Signal& signal, const History& surfaces,
                          const Accumulated& accumulated) const {
        const SvgfReprojectParams params = reprojectParams();
        return recordReasons(
            graph_, input_, surfaces,
            {.method = "svgf",
             .signal = signal.name,
             .tests = params.tests,
             .frames = accumulated.momentsKept,
             .longest = params.longest,
             .shortens = settings_.antilag > 0.0f,
             .reflectionMotion = signal.reflects ? input_.reflectionMotion : ImageHandle{},
             .lobeScale = hasRoughness(signal) && settings_.lobeTest > 0.0f ? params.lobeScale : 0.0f});
    }

    /// Shortens histories where light has changed.
    void followChanges(const std::vector<Signal>& all, const std::vector<Accumulated>& accumulated) {
        const SvgfLagParams lag = lagParams();
        for (size_t i = 0; i < all.size() && !buffers_; ++i)
            recordTileSums(graph_, "svgf/tiles " + all[i].name, accumulated[i].moments,
                           accumulated[i].tileSums, lag);
        for (size_t i = 0; i < all.size(); ++i)
            recordTileLags(graph_, "svgf/lags " + all[i].name, accumulated[i].tileSums, accumulated[i].tiles,
                           lag, settings_.antilagAround);
        for (size_t i = 0; i < all.size(); ++i) shortenHistory(all[i], accumulated[i]);
    }

    void shortenHistory(const Signal& signal, const Accumulated& accumulated) {
        const SvgfAntilagParams params{.width = extent_.width,
                                       .height = extent_.height,
                                       .minAlbedo = minAlbedo(),
                                       .ofMean = ofMean(),
                                       .alpha = settings_.alpha,
                                       .alphaMoments = settings_.alphaMoments,
                                       .alphaFast = settings_.alphaFast};
        graph_.dispatch({.pass = "svgf/antilag " + signal.name,
                         .shader = choose(shaders::svgf_antilag_comp, shaders::svgf_antilag_buffers_comp),
                         .bindings = withLight(signal, {{"tiles", accumulated.tiles},
                                                        {"moments", accumulated.moments},
                                                        {"color", accumulated.color}}),
                         .params = gpu::paramsOf(params),
                         .constants = constantsOf(signal),
                         .extent = extent_});
    }

    SvgfFilterParams filterParams(int step) const {
        SvgfFilterParams params{};
        params.camera = input_.camera;
        params.width = extent_.width;
        params.height = extent_.height;
        params.step = step;
        params.phiColor = settings_.phiColor;
        params.normalScale = log2e * (settings_.position ? 1.0f / settings_.phiNormal : settings_.phiNormal);
        params.depthScale = log2e / settings_.phiDepth;
        params.roughnessScale = log2e / (255.0f * std::max(settings_.phiRoughness, 1e-6f));
        params.stabilisationNoise = settings_.stabilisationNoise;
        params.fireflies = settings_.fireflies;
        params.youngRadius = settings_.youngRadius;
        params.samples = samples();
        return params;
    }

    std::vector<gpu::ConstantValue> filterConstants(const Signal& signal) const {
        return {{"POSITION", settings_.position ? 1u : 0u},
                {"ORTHOGRAPHIC", input_.camera.orthographic},
                {"ROUGHNESS", hasRoughness(signal) && settings_.phiRoughness > 0.0f ? 1u : 0u}};
    }

    void estimateVariance(const Signal& signal, const History& surfaces, const Accumulated& accumulated) {
        const SvgfFilterParams params = filterParams(1);
        std::vector<gpu::ConstantValue> constants = filterConstants(signal);
        constants.push_back({"BOOST", settings_.boost ? 1u : 0u});
        constants.push_back({"FIREFLIES", settings_.fireflies > 0.0f ? 1u : 0u});
        std::vector<gpu::Binding> bindings{
            {"surfaces", surfaces.current}, {"moments", accumulated.moments}, {"color", accumulated.color}};
        if (buffers_) bindings.push_back({"youngTiles", accumulated.youngTiles});
        graph_.dispatch({.pass = "svgf/variance " + signal.name,
                         .shader = choose(shaders::svgf_variance_comp, shaders::svgf_variance_buffers_comp),
                         .bindings = bindings,
                         .params = gpu::paramsOf(params),
                         .constants = constants,
                         .extent = buffers_ ? extent_ : levelInvocations(extent_, 1, {1, SVGF_COLUMN})});
    }

    const gpu::ShaderCode& levelShader(bool last) const {
        if (last) return choose(shaders::svgf_last_level_comp, shaders::svgf_last_level_buffers_comp);
        return choose(shaders::svgf_level_comp, shaders::svgf_level_buffers_comp);
    }

    /// The result of one level for one signal.
    ImageHandle levelTarget(const Signal& signal, const Accumulated& accumulated, int number) {
        if (number == fedBack()) return accumulated.feedback.current;
        return graph_.transient("svgf/level " + std::to_string(number) + " " + signal.name,
                                Format::RGBA16Float, extent_, input_.filters);
    }

    std::vector<gpu::ConstantValue> levelConstants(const std::vector<Signal>& signals, int number) const {
        // Only the last signal may be specular, and compare roughness.
        std::vector<gpu::ConstantValue> constants = filterConstants(signals.back());
        constants.insert(constants.end(), {{"BLUR_VARIANCE", number <= settings_.blurLevels ? 1u : 0u},
                                           {"WIDE", settings_.wide ? 1u : 0u},
                                           {"SIDE_BY_SIDE", levelStep(number) == 1 ? 1u : 0u},
                                           {"LOOKS", number <= settings_.meanLevels ? 1u : 0u},
                                           // Not in the first level: its deviations are those of single
                                           // pixels, and say too little.
                                           {"DAMP_OUTLIERS", settings_.dampOutliers && number > 1 ? 1u : 0u},
                                           {"BOTH", signals.size() > 1 ? 1u : 0u}});
        return constants;
    }

    /// An image of one pixel, where a level could write a second signal.
    ImageHandle noSecond(const std::string& what, Format format) {
        return graph_.transient("svgf/no second" + what, format, {1, 1}, input_.filters);
    }

    /// What the last level reads and writes besides.
    std::vector<gpu::Binding> stableBindings(const std::vector<Accumulated>& accumulated) {
        const Accumulated &a = accumulated.front(), &b = accumulated.back();
        const bool both = accumulated.size() > 1;
        return {{"stablePastA", a.stablePast},
                {"stablePastB", b.stablePast},
                {"stableA", a.stable.current},
                {"stableB", both ? b.stable.current : noSecond(" stable", Format::R32Uint)},
                {"momentsA", a.moments},
                {"momentsB", b.moments}};
    }

    /// All signals in one pass: they have the same surfaces and, but for roughness, the same weights of
    /// surfaces.
    std::vector<ImageHandle> level(const std::vector<Signal>& signals, const History& surfaces,
                                   const std::vector<Accumulated>& accumulated,
                                   const std::vector<ImageHandle>& before, int number) {
        const bool mixed = stabilises() && number == settings_.levels, both = signals.size() > 1;
        std::vector<ImageHandle> filtered;
        for (size_t i = 0; i < signals.size(); ++i)
            filtered.push_back(levelTarget(signals[i], accumulated[i], number));
        if (!both && !noSecond_) noSecond_ = noSecond("", Format::RGBA16Float);
        std::vector<gpu::Binding> bindings{{"surfaces", surfaces.current},
                                           {"signalA", before.front()},
                                           {"signalB", before.back()},
                                           {"filteredA", filtered.front()},
                                           {"filteredB", both ? filtered.back() : noSecond_}};
        if (mixed) {
            const std::vector<gpu::Binding> stable = stableBindings(accumulated);
            bindings.insert(bindings.end(), stable.begin(), stable.end());
        }
        const int step = levelStep(number);
        SvgfFilterParams params = filterParams(step);
        params.stabilisationAlpha = accumulated.front().stable.valid ? settings_.stabilisationAlpha : 1.0f;
        graph_.dispatch({.pass = "svgf/level " + std::to_string(number),
                         .shader = levelShader(mixed),
                         .bindings = bindings,
                         .params = gpu::paramsOf(params),
                         .constants = levelConstants(signals, number),
                         .extent = levelInvocations(extent_, step, {1, SVGF_COLUMN})});
        return filtered;
    }

    /// After the first level, whose result is replaced. A last level stabilises, and has to come afterwards.
    bool fillsYoung() const { return settings_.youngRadius > 0 && settings_.levels > 1; }

    void fillYoung(const Signal& signal, const History& surfaces, const Accumulated& accumulated,
                   ImageHandle filtered) {
        std::vector<gpu::Binding> bindings{{"surfaces", surfaces.current},
                                           {"moments", accumulated.moments},
                                           {"signal", accumulated.color},
                                           {"filtered", filtered}};
        if (buffers_) bindings.push_back({"youngTiles", accumulated.youngTiles});
        graph_.dispatch({.pass = "svgf/young " + signal.name,
                         .shader = choose(shaders::svgf_young_comp, shaders::svgf_young_buffers_comp),
                         .bindings = bindings,
                         .params = gpu::paramsOf(filterParams(1)),
                         .constants = filterConstants(signal),
                         .extent = extent_});
    }

    /// The radiance of one signal, without emission. `otherAlbedo`: empty, or its light was reflected by
    /// both.
    ImageHandle radianceOf(const std::string& name, ImageHandle light, ImageHandle albedo,
                           ImageHandle otherAlbedo = {}) {
        return compose(
            graph_, "svgf/compose " + name,
            {.light = light, .albedo = albedo, .secondAlbedo = otherAlbedo, .minAlbedo = minAlbedo()});
    }

    FrameGraph& graph_;
    const DenoiserInput& input_;
    const SvgfSettings& settings_;
    const Extent extent_;
    const bool buffers_;
    ImageHandle noSecond_;  ///< for all levels
};

}  // namespace

SvgfStages recordSvgfStages(FrameGraph& graph, const DenoiserInput& input, const SvgfSettings& settings) {
    return Svgf(graph, input, settings).record();
}

DenoiserOutput composeSvgf(FrameGraph& graph, const DenoiserInput& input, const FilterSettings& settings,
                           const SvgfStages& stages, const SvgfLight& light) {
    DenoiserInput own = input;
    own.target = targetBeforeTaa(graph, input, settings.taa);
    Svgf svgf(graph, own, settings.svgf);
    DenoiserOutput output{.beauty = antialias(graph, input, svgf.beautyOf(light), settings.taa),
                          .disocclusion = {},
                          .frames = stages.signals.front().moments,
                          .reasons = stages.reasons};
    if (input.wantsSignals) svgf.addSignals(light, output);
    return output;
}

DenoiserOutput svgf::record(FrameGraph& graph, const DenoiserInput& input, const FilterSettings& settings) {
    const SvgfStages stages = recordSvgfStages(graph, input, settings.svgf);
    return composeSvgf(graph, input, settings, stages,
                       {stages.signals.front().filtered, stages.signals.back().filtered});
}

}  // namespace limpid::denoise
