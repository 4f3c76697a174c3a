#include "denoise/methods/visibility/visibility.h"

#include <algorithm>
#include <numbers>
#include <string>

#include "denoise/methods/methods.h"
#include "denoise/methods/svgf/svgf_lags.h"
#include "denoise/methods/visibility/visibility_params.h"
#include "denoise/stages/atrous/levels.h"
#include "denoise/stages/surfaces/surfaces.h"
#include "svgf_young_buffers_one_channel.comp.h"
#include "svgf_young_one_channel.comp.h"
#include "visibility_accumulate.comp.h"
#include "visibility_accumulate_buffers.comp.h"
#include "visibility_antilag.comp.h"
#include "visibility_antilag_buffers.comp.h"
#include "visibility_level.comp.h"
#include "visibility_level_buffers.comp.h"

namespace limpid::denoise {
namespace {

using gpu::Extent;
using gpu::Format;
using gpu::FrameGraph;
using gpu::History;
using gpu::ImageHandle;

/// Pixels of a tile that count as changed, in deviations. As in SVGF, a single one never does.
constexpr float visibilityPixel = 2.5f;

class Visibility {
  public:
    Visibility(FrameGraph& graph, const DenoiserInput& input, const VisibilitySettings& settings)
        : graph_(graph),
          input_(input),
          settings_(settings),
          extent_(graph.extent(input.diffuse)),
          buffers_(input.filters == gpu::Backing::Buffer),
          surfaces_(recordSurfaces(graph, input)),
          moments_(graph.history("visibility/moments", Format::RGBA16Float, extent_)) {}

    DenoiserOutput record() {
        ImageHandle signal = accumulate();
        if (settings_.antilag > 0.0f) shortenHistory(signal);
        for (int number = 1; number <= settings_.levels; ++number) {
            const ImageHandle filtered = level(signal, number);
            if (number == 1 && settings_.levels > 1 && settings_.youngRadius > 0) fillYoung(signal, filtered);
            signal = filtered;
        }
        DenoiserOutput result{.beauty = signal, .disocclusion = {}, .frames = moments_.current};
        if (input_.reasons.wanted) result.reasons.push_back(reasons());
        return result;
    }

  private:
    const gpu::ShaderCode& choose(const gpu::ShaderCode& images, const gpu::ShaderCode& buffers) const {
        return buffers_ ? buffers : images;
    }

    ReprojectTests tests() const {
        return {.normal = settings_.normalTest,
                .depth = settings_.depthTest,
                .relative = 1,
                .search = 1,
                .previousNormals = input_.normalEncoding,
                .motion = input_.motionEncoding};
    }

    float longest() const { return std::max(SVGF_YOUNG, 1.0f / settings_.alpha); }

    VisibilityAlphas alphas() const { return {settings_.alpha, settings_.alphaFast}; }

    ImageHandle makeSignal(const std::string& name, Extent extent) {
        return graph_.transient(name, Format::R32Uint, extent, input_.filters);
    }

    /// Adds the images and the constant that visibility_sample.glsl declares.
    std::vector<gpu::Binding> withSample(std::vector<gpu::Binding> others) const {
        others.push_back({"diffuse", input_.diffuse});
        others.push_back({"emission", input_.emission ? input_.emission : input_.diffuse});
        return others;
    }

    gpu::ConstantValue emission() const { return {"EMISSION", input_.emission ? 1u : 0u}; }

    ImageHandle accumulate() {
        const ImageHandle signal = makeSignal("visibility/signal", extent_);
        VisibilityAccumulateParams params{};
        params.camera = input_.camera;
        params.width = extent_.width;
        params.height = extent_.height;
        params.tests = tests();
        params.alphas = alphas();
        params.longest = longest();
        graph_.dispatch(
            {.pass = "visibility/accumulate",
             .shader =
                 choose(shaders::visibility_accumulate_comp, shaders::visibility_accumulate_buffers_comp),
             .bindings = withSample(
                 {{"motion", input_.motion},
                  {"previousNormal", input_.previousNormal ? input_.previousNormal : input_.motion},
                  {"surfaces", surfaces_.current},
                  {"surfacesBefore", surfaces_.previous},
                  {"momentsBefore", moments_.previous},
                  {"moments", moments_.current},
                  {"signal", signal}}),
             .params = gpu::paramsOf(params),
             .constants = {emission(), {"TURNS", input_.previousNormal ? 1u : 0u}},
             .extent = extent_});
        return signal;
    }

    SvgfLagParams lagParams() const {
        return svgfLagParams({.slow = settings_.alpha,
                              .fast = settings_.alphaFast,
                              .antilag = settings_.antilag,
                              .noise = settings_.antilagNoise,
                              .pixel = visibilityPixel});
    }

    void shortenHistory(ImageHandle signal) {
        const Extent edge = tilesOf(extent_, SVGF_TILE);
        const ImageHandle sums = graph_.transient("visibility/tile sums", Format::RGBA32Float, edge);
        const ImageHandle tiles = graph_.transient("visibility/tiles", Format::R32Float, edge);
        recordTileSums(graph_, "visibility/tiles", moments_.current, sums, lagParams());
        recordTileLags(graph_, "visibility/lags", sums, tiles, lagParams(), true);
        const VisibilityAntilagParams params{extent_.width, extent_.height, alphas()};
        graph_.dispatch(
            {.pass = "visibility/antilag",
             .shader = choose(shaders::visibility_antilag_comp, shaders::visibility_antilag_buffers_comp),
             .bindings = withSample({{"tiles", tiles}, {"moments", moments_.current}, {"signal", signal}}),
             .params = gpu::paramsOf(params),
             .constants = {emission()},
             .extent = extent_});
    }

    SvgfFilterParams filterParams(int step) const {
        constexpr float log2e = std::numbers::log2e_v<float>;  // the shaders take powers of 2
        SvgfFilterParams params{};
        params.camera = input_.camera;
        params.width = extent_.width;
        params.height = extent_.height;
        params.step = step;
        params.phiColor = settings_.phi;
        params.youngRadius = settings_.youngRadius;
        params.samples = 1.0f;
        params.normalScale = log2e * settings_.phiNormal;
        params.depthScale = log2e / settings_.phiDepth;
        return params;
    }

    std::vector<gpu::ConstantValue> surfaceConstants() const {
        return {{"ORTHOGRAPHIC", input_.camera.orthographic}, {"POSITION", 0u}, {"ROUGHNESS", 0u}};
    }

    /// The last level writes the picture, the others the signal; the other image is a stand-in of one pixel.
    ImageHandle level(ImageHandle before, int number) {
        const std::string name = "visibility/level " + std::to_string(number);
        const bool last = number == settings_.levels;
        const Extent none{1, 1};
        const ImageHandle filtered = makeSignal(last ? name + " unused" : name, last ? none : extent_);
        const ImageHandle picture = graph_.transient(last ? "visibility/picture" : name + " no picture",
                                                     Format::RGBA32Float, last ? extent_ : none);
        const int step = levelStep(number);
        std::vector<gpu::ConstantValue> constants = surfaceConstants();
        constants.push_back({"BLUR_VARIANCE", number == 1 ? 1u : 0u});
        constants.push_back({"LAST", last ? 1u : 0u});
        graph_.dispatch(
            {.pass = name,
             .shader = choose(shaders::visibility_level_comp, shaders::visibility_level_buffers_comp),
             .bindings = {{"surfaces", surfaces_.current},
                          {"signal", before},
                          {"filtered", filtered},
                          {"picture", picture}},
             .params = gpu::paramsOf(filterParams(step)),
             .constants = constants,
             .extent = levelInvocations(extent_, step, {1, SVGF_COLUMN})});
        return last ? picture : filtered;
    }

    /// After the first level, whose result is replaced. A last level writes the picture instead.
    void fillYoung(ImageHandle signal, ImageHandle filtered) {
        graph_.dispatch({.pass = "visibility/young",
                         .shader = choose(shaders::svgf_young_one_channel_comp,
                                          shaders::svgf_young_buffers_one_channel_comp),
                         .bindings = {{"surfaces", surfaces_.current},
                                      {"moments", moments_.current},
                                      {"signal", signal},
                                      {"filtered", filtered}},
                         .params = gpu::paramsOf(filterParams(1)),
                         .constants = surfaceConstants(),
                         .extent = extent_});
    }

    SignalReasons reasons() const {
        return recordReasons(graph_, input_, surfaces_,
                             {.method = "visibility",
                              .signal = "visibility",
                              .tests = tests(),
                              .frames = moments_,
                              .longest = longest(),
                              .shortens = settings_.antilag > 0.0f});
    }

    FrameGraph& graph_;
    const DenoiserInput& input_;
    const VisibilitySettings& settings_;
    const Extent extent_;
    const bool buffers_;
    const History surfaces_;
    const History moments_;
};

}  // namespace

const ParamTable<VisibilitySettings>& visibility::params() {
    static const auto table = [] {
        using S = VisibilitySettings;
        ParamTable<S> t("visibility");
        t.add("alpha", &S::alpha, 1e-4, 1.0, "",
              "Minimum weight of a new frame in the running mean; lower is smoother, higher follows changes "
              "faster");
        t.add("alpha_fast", &S::alphaFast, 1e-4, 1.0, "",
              "Minimum weight of a new frame in the fast mean that anti-lag compares with; higher reacts "
              "faster");
        t.add("normal_test", &S::normalTest, -1.0, 1.0, "cosine",
              "Minimum cosine between a previous pixel's normal and the expected one; higher keeps edges, "
              "lower keeps more history")
            .slider(0.5, 1);
        t.add("depth_test", &S::depthTest, 0.0, 1e6, "of the distance",
              "Maximum deviation from the expected distance; lower ghosts less, higher loses less history")
            .slider(0, 1, SliderScale::Logarithmic, 0.001);
        t.add("antilag", &S::antilag, 0.0, 1e6, "",
              "History dropped per relative change of visibility beyond noise; higher follows moving shadows "
              "faster and is noisier; below 0.1 is off");
        t.add("antilag_noise", &S::antilagNoise, 0.0, 100.0, "deviations",
              "Change of a tile's mean that still counts as noise; lower detects smaller changes and more "
              "false ones")
            .slider(0, 10);
        t.add(
            "young_radius", &S::youngRadius, 0, 16, "pixels",
            "Reach of the first filter pass where there is only one frame yet (half as far with four); more "
            "is smoother and slower there; 0 (and fewer than 2 levels) is off");
        t.add("levels", &S::levels, 1, 10, "levels",
              "Number of filter passes; n passes reach 2^n - 1 pixels; more is smoother and slower");
        t.add("phi", &S::phi, 1e-6, 1e9, "deviations",
              "Tolerated difference of visibility; higher smooths across shadows")
            .slider(0.1, 100, SliderScale::Logarithmic);
        t.add("phi_normal", &S::phiNormal, 1e-6, 1e5, "",
              "Sharpness of the comparison of normals; lower smooths across edges");
        t.add(
            "phi_depth", &S::phiDepth, 1e-6, 1e9, "slopes",
            "Tolerated difference of distance, relative to the surface's slope; higher smooths across steps");
        return t;
    }();
    return table;
}

DenoiserOutput filterVisibility(FrameGraph& graph, const DenoiserInput& input,
                                const VisibilitySettings& settings) {
    return Visibility(graph, input, settings).record();
}

DenoiserOutput visibility::record(FrameGraph& graph, const DenoiserInput& input,
                                  const FilterSettings& settings) {
    DenoiserOutput result = filterVisibility(graph, input, settings.visibility);
    result.beauty = antialias(graph, input, result.beauty, settings.taa);
    return result;
}

}  // namespace limpid::denoise
