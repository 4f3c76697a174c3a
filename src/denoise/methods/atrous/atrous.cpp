#include "denoise/methods/atrous/atrous.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "atrous_demodulate.comp.h"
#include "atrous_demodulate_buffers.comp.h"
#include "atrous_level.comp.h"
#include "atrous_level_buffers.comp.h"
#include "denoise/methods/atrous/atrous_params.h"
#include "denoise/methods/methods.h"
#include "denoise/stages/atrous/levels.h"
#include "denoise/stages/compose/compose.h"

namespace limpid::denoise {
namespace {

using gpu::Backing;
using gpu::Extent;
using gpu::FrameGraph;
using gpu::ImageHandle;

struct Demodulated {
    ImageHandle light;     ///< half4: demodulated; alpha: something is seen
    ImageHandle geometry;  ///< two words: octahedral normal, depth
};

float minAlbedo(const AtrousSettings& settings) {
    return settings.demodulate ? settings.minAlbedo : 0.0f;
}

Demodulated demodulate(FrameGraph& graph, const DenoiserInput& input, const AtrousLight& light,
                       const AtrousSettings& settings) {
    const Extent extent = graph.extent(input.diffuse);
    const Demodulated signal{
        graph.transient("atrous/demodulated", gpu::Format::RGBA16Float, extent, input.filters),
        graph.transient("atrous/geometry", gpu::Format::RG32Uint, extent, input.filters)};
    const AtrousDemodulateParams params{input.camera,        extent.width,
                                        extent.height,       settings.plane ? 1u : 0u,
                                        minAlbedo(settings), light.minAlbedo};
    const bool buffers = input.filters == Backing::Buffer;
    graph.dispatch(
        {.pass = "atrous/demodulate",
         .shader = buffers ? shaders::atrous_demodulate_buffers_comp : shaders::atrous_demodulate_comp,
         .bindings = {{"lightA", light.first},
                      {"lightB", light.second ? light.second : light.first},
                      {"albedo", input.albedo},
                      {"normal", input.normal},
                      {"depth", input.depth},
                      {"signal", signal.light},
                      {"geometry", signal.geometry}},
         .params = gpu::paramsOf(params),
         .constants = {{"TWO_LIGHTS", light.second ? 1u : 0u}, {"MEAN", light.isMean ? 1u : 0u}},
         .extent = extent});
    return signal;
}

ImageHandle level(FrameGraph& graph, const DenoiserInput& input, const Demodulated& signal, int number,
                  const AtrousSettings& settings) {
    const Extent extent = graph.extent(signal.light);
    const std::string name = "atrous/level " + std::to_string(number);
    const ImageHandle filtered = graph.transient(name, gpu::Format::RGBA16Float, extent, input.filters);
    const int step = levelStep(number);
    constexpr float log2e = std::numbers::log2e_v<float>;  // the shader takes powers of 2
    AtrousLevelParams params{};
    params.camera = input.camera;
    params.width = extent.width;
    params.height = extent.height;
    params.step = step;
    params.normalScale =
        2.0f * log2e / (static_cast<float>(step) * static_cast<float>(step) * settings.normalFactor);
    params.toScreen = {2.0f / static_cast<float>(extent.width), -2.0f / static_cast<float>(extent.height)};
    params.depthScale = std::sqrt(log2e / settings.depthFactor);
    const float samplesGathered = static_cast<float>(step) * static_cast<float>(step);
    params.fade = settings.sampleTarget > 0.0f ? samplesGathered / settings.sampleTarget : 0.0f;
    const bool color = settings.colorFactor > 0.0f;
    // Finite, so that equal light weighs 1 however small the tolerance.
    if (color) params.colorScale = std::min(samplesGathered * log2e / settings.colorFactor, 1e30f);
    const bool buffers = input.filters == Backing::Buffer;
    const Extent block = buffers ? Extent{2, 2} : Extent{4, 2};  // as in the shader
    graph.dispatch(
        {.pass = name,
         .shader = buffers ? shaders::atrous_level_buffers_comp : shaders::atrous_level_comp,
         .bindings = {{"signal", signal.light}, {"geometry", signal.geometry}, {"filtered", filtered}},
         .params = gpu::paramsOf(params),
         .constants = {{"PLANE", settings.plane ? 1u : 0u},
                       {"ORTHOGRAPHIC", input.camera.orthographic},
                       {"COLOR", color ? 1u : 0u}},
         .extent = levelInvocations(extent, step, block)});
    return filtered;
}

}  // namespace

const ParamTable<AtrousSettings>& atrous::params() {
    static const auto table = [] {
        using S = AtrousSettings;
        ParamTable<S> t("atrous");
        t.add("temporal", &S::temporal,
              "Filter the running means of `temporal`; off: the samples of the current frame");
        t.add("levels", &S::levels, 0, 10, "levels",
              "Number of filter passes; n passes reach 2^(n+1) - 2 pixels; more is smoother and slower");
        t.add("normal_factor", &S::normalFactor, 1e-9, 1e9, "",
              "Tolerated squared difference of normals at level 1, four times as much at each further level; "
              "higher smooths across edges and curves");
        t.add("depth_factor", &S::depthFactor, 1e-12, 1e12, "of the squared distance",
              "Tolerated squared deviation from the pixel's plane, relative to the distance (without "
              "`plane`: squared difference of depths); higher smooths across steps");
        t.add("sample_target", &S::sampleTarget, 0.0, 1e9, "samples",
              "Number of samples, over time and levels, at which a pixel's own weight is doubled; lower "
              "keeps shadows sharper, higher is smoother; 0 is off");
        t.add(
            "plane", &S::plane,
            "Weigh neighbours by their distance from the pixel's plane instead of their difference in depth");
        t.add("demodulate", &S::demodulate, "Filter light without albedo; keeps textures sharp");
        t.add("min_albedo", &S::minAlbedo, 1e-3, 1.0, "",
              "Minimum albedo that `demodulate` divides by; lower keeps the colours of dark surfaces apart, "
              "higher limits their noise")
            .slider(1e-3, 1, SliderScale::Logarithmic);
        t.add("color_factor", &S::colorFactor, 0.0, 1e9, "(cd/m^2)^2",
              "Tolerated squared difference of light at level 1, a quarter at each further level (Dammertz "
              "2010); lower keeps shadows and noise; 0 ignores light");
        return t;
    }();
    return table;
}

ImageHandle filterAtrous(FrameGraph& graph, const DenoiserInput& input, const AtrousLight& light,
                         const AtrousSettings& settings) {
    Demodulated signal = demodulate(graph, input, light, settings);
    for (int number = 1; number <= settings.levels; ++number)
        signal.light = level(graph, input, signal, number, settings);
    return compose(graph, "atrous/compose",
                   {.light = signal.light,
                    .albedo = input.albedo,
                    .emission = input.emission,
                    .target = input.target,
                    .minAlbedo = minAlbedo(settings)});
}

DenoiserOutput atrous::record(gpu::FrameGraph& graph, const DenoiserInput& input,
                              const FilterSettings& settings) {
    if (!settings.atrous.temporal)
        return {antialias(graph, input,
                          filterAtrous(graph, input, {input.diffuse, input.specular}, settings.atrous),
                          settings.taa),
                {}};
    const TemporalImages accumulated = accumulateTemporally(graph, input, settings.temporal);
    if (settings.temporal.showDisocclusion) return composeTemporal(graph, input, accumulated, settings);
    const gpu::ImageHandle filtered = filterAtrous(
        graph, input, {.first = accumulated.color, .minAlbedo = accumulated.minAlbedo, .isMean = true},
        settings.atrous);
    return {antialias(graph, input, filtered, settings.taa), accumulated.disocclusion, accumulated.color,
            accumulated.reasons};
}

}  // namespace limpid::denoise
