#include "denoise/methods/nano/nano_recorder.h"

#include <array>
#include <string>

#include "denoise/methods/methods.h"
#include "denoise/methods/nano/nano_matrices.h"
#include "nano_convolve.comp.h"
#include "nano_features.comp.h"
#include "nano_features_buffers.comp.h"
#include "nano_filter.comp.h"
#include "nano_finest.comp.h"
#include "nano_finest_buffers.comp.h"
#include "nano_pool.comp.h"

namespace limpid::denoise {
namespace {

using gpu::Backing;
using gpu::Extent;
using gpu::Format;
using gpu::ImageHandle;

/// The number of the logit that weighs a pixel in the next coarser level, the last of a signal's.
constexpr uint32_t poolLogit(size_t level) {
    const bool finest = level == 0;
    const int edge = 2 * (finest ? NANO_FINEST_REACH : NANO_REACH) + 1, shares = finest ? 2 : 0;
    return static_cast<uint32_t>(edge * edge + NANO_COARSER_TAPS + shares);
}

class Recorder {
  public:
    Recorder(gpu::FrameGraph& graph, const DenoiserInput& input, const SvgfStages& svgf,
             const NanoNetwork& network, float strength)
        : graph_(graph),
          input_(input),
          svgf_(svgf),
          network_(network),
          strength_(strength),
          buffers_(input.filters == Backing::Buffer),
          picture_(graph.extent(svgf.signals.front().filtered)) {
        constexpr uint32_t multiple = 1u << (NANO_LEVELS - 1);
        for (size_t i = 0; i < NANO_LEVELS; ++i)
            extents_[i] = {(picture_.width + multiple - 1) / multiple * multiple >> i,
                           (picture_.height + multiple - 1) / multiple * multiple >> i};
    }

    /// Returns the light of both signals.
    SvgfLight record() {
        weights_ =
            graph_.transient(name("weights"), Format::RGBA32Uint,
                             {static_cast<uint32_t>(network_.weights.size() / 16), 1}, Backing::Buffer);
        graph_.upload(weights_, network_.weights);
        ImageHandle channels = features();
        std::array<ImageHandle, NANO_LEVELS> kept;
        for (size_t i = 0; i < NANO_LEVELS; ++i) {
            const NanoLevel& level = network_.levels[i];
            if (i > 0) channels = convolve(name("halve", i), level.halve, i, NANO_HALVE, channels);
            for (size_t n = 0; n < level.around.size(); ++n)
                channels = convolve(name("around", i) + "." + std::to_string(n + 1), level.around[n], i,
                                    NANO_AROUND, channels);
            kept[i] = channels;
        }
        for (size_t i = NANO_LEVELS - 1; i-- > 0;) {
            const NanoLevel& level = network_.levels[i];
            const ImageHandle joined =
                convolve(name("join", i), level.join, i, NANO_POINT, kept[i], kept[i + 1]);
            kept[i] = convolve(name("after", i), level.after, i, NANO_AROUND, joined);
        }
        for (size_t i = 0; i + 1 < NANO_LEVELS; ++i) pool(i, kept[i]);
        ImageHandle result;
        for (size_t i = NANO_LEVELS - 1; i > 0; --i) result = filter(i, kept[i], result);
        return finest(kept[0], result);
    }

  private:
    std::string name(const std::string& what) const { return network_.name + "/" + what; }
    std::string name(const std::string& what, size_t level) const {
        return name(what + " " + std::to_string(level));
    }

    /// A buffer with `groups` texels for each pixel of the level.
    ImageHandle texels(const std::string& name, size_t level, uint32_t groups) {
        return graph_.transient(name, Format::RGBA32Uint,
                                {extents_[level].width * groups, extents_[level].height}, Backing::Buffer);
    }

    ImageHandle features() {
        const ImageHandle channels = texels(name("channels"), 0, network_.levels[0].halve.outputs);
        light_[0] = texels(name("light", 0), 0, 1);
        const SvgfSignalStages &a = svgf_.signals.front(), &b = svgf_.signals.back();
        const NanoFeaturesParams params{.camera = input_.camera,
                                        .width = picture_.width,
                                        .height = picture_.height,
                                        .paddedWidth = extents_[0].width,
                                        .paddedHeight = extents_[0].height};
        graph_.dispatch(
            {.pass = name("features"),
             .shader = buffers_ ? shaders::nano_features_buffers_comp : shaders::nano_features_comp,
             .bindings = {{"surfaces", svgf_.surfaces},
                          {"colorA", a.accumulated},
                          {"colorB", b.accumulated},
                          {"firstA", a.first},
                          {"firstB", b.first},
                          {"filteredA", a.filtered},
                          {"filteredB", b.filtered},
                          {"pastA", a.past},
                          {"pastB", b.past},
                          {"momentsA", a.moments},
                          {"momentsB", b.moments},
                          {"albedoA", input_.albedo},
                          {"albedoB", input_.albedoSpecular ? input_.albedoSpecular : input_.albedo},
                          {"weights", weights_},
                          {"channels", channels},
                          {"light", light_[0]}},
             .params = gpu::paramsOf(params),
             .constants = {{"TWO_SIGNALS", twoSignals() ? 1u : 0u},
                           {"HAS_PAST", svgf_.stabilised ? 1u : 0u},
                           {"OUTPUT_GROUPS", network_.levels[0].halve.outputs}},
             .extent = extents_[0]});
        return channels;
    }

    /// Without the network's result, SVGF's own stays, which has not been rounded to halves.
    bool replacesStable() const { return svgf_.stabilised && strength_ > 0.0f; }

    bool twoSignals() const { return svgf_.signals.size() > 1; }

    const NanoShare& shareOf(size_t level, uint32_t taps) const {
        const NanoShares& shares = network_.shares;
        return (taps == NANO_AROUND  ? shares.around
                : taps == NANO_HALVE ? shares.halve
                                     : shares.point)[level];
    }

    ImageHandle convolve(const std::string& pass, const NanoLayer& layer, size_t level, uint32_t taps,
                         ImageHandle inputs, ImageHandle coarser = {}) {
        const ImageHandle outputs = texels(pass, level, layer.outputs);
        const Extent extent = extents_[level];
        const NanoConvolveParams params{.width = extent.width,
                                        .height = extent.height,
                                        .groups = layer.inputs,
                                        .coarserGroups = layer.coarser,
                                        .outputGroups = layer.outputs,
                                        .weights = layer.weights};
        if (!coarser) coarser = inputs;
        if (input_.matrices) {
            convolveByMatrices(
                graph_, {pass, shareOf(level, taps), taps, params, inputs, coarser, weights_, outputs});
            return outputs;
        }
        graph_.dispatch(
            {.pass = pass,
             .shader = shaders::nano_convolve_comp,
             .bindings =
                 {{"inputs", inputs}, {"coarser", coarser}, {"weights", weights_}, {"outputs", outputs}},
             .params = gpu::paramsOf(params),
             .constants = {{"TAPS", taps}},
             .extent = {(extent.width + NANO_PIXELS - 1) / NANO_PIXELS, extent.height * layer.outputs}});
        return outputs;
    }

    NanoFilterParams filterParams(size_t level) const {
        const NanoLayer& layer = network_.levels[level].logits;
        const Extent padded = extents_[level], filtered = level == 0 ? picture_ : padded;
        return {.width = filtered.width,
                .height = filtered.height,
                .paddedWidth = padded.width,
                .paddedHeight = padded.height,
                .groups = layer.inputs,
                .logitGroups = layer.outputs / 2,
                .weights = layer.weights,
                .strength = strength_};
    }

    void pool(size_t level, ImageHandle channels) {
        light_[level + 1] = texels(name("light", level + 1), level + 1, 1);
        const NanoFilterParams params = filterParams(level);
        graph_.dispatch({.pass = name("pool", level + 1),
                         .shader = shaders::nano_pool_comp,
                         .bindings = {{"inputs", channels},
                                      {"weights", weights_},
                                      {"light", light_[level]},
                                      {"pooled", light_[level + 1]}},
                         .params = gpu::paramsOf(params),
                         .constants = {{"LOGIT", poolLogit(level)}},
                         .extent = extents_[level + 1]});
    }

    ImageHandle filter(size_t level, ImageHandle channels, ImageHandle coarser) {
        const ImageHandle result = texels(name("filtered", level), level, 1);
        const NanoFilterParams params = filterParams(level);
        graph_.dispatch({.pass = name("filter", level),
                         .shader = shaders::nano_filter_comp,
                         .bindings = {{"inputs", channels},
                                      {"weights", weights_},
                                      {"light", light_[level]},
                                      {"coarser", coarser ? coarser : light_[level]},
                                      {"result", result}},
                         .params = gpu::paramsOf(params),
                         .constants = {{"COARSER", coarser ? 1u : 0u}},
                         .extent = extents_[level]});
        return result;
    }

    SvgfLight finest(ImageHandle channels, ImageHandle coarser) {
        const auto image = [&](const std::string& called) {
            return graph_.transient(called, Format::RGBA16Float, picture_, input_.filters);
        };
        const SvgfSignalStages &a = svgf_.signals.front(), &b = svgf_.signals.back();
        const ImageHandle stableToo =
            twoSignals() ? b.stable
                         : graph_.transient(name("no second"), Format::R32Uint, {1, 1}, input_.filters);
        const SvgfLight results{image(name("diffuse")), image(name("specular"))};
        const NanoFilterParams params = filterParams(0);
        graph_.dispatch({.pass = name("filter", 0),
                         .shader = buffers_ ? shaders::nano_finest_buffers_comp : shaders::nano_finest_comp,
                         .bindings = {{"inputs", channels},
                                      {"weights", weights_},
                                      {"light", light_[0]},
                                      {"coarser", coarser},
                                      {"filteredA", a.filtered},
                                      {"filteredB", b.filtered},
                                      {"resultA", results[0]},
                                      {"resultB", results[1]},
                                      {"stableA", a.stable},
                                      {"stableB", stableToo}},
                         .params = gpu::paramsOf(params),
                         .constants = {{"COARSER", 1u},
                                       {"STABILISE", replacesStable() ? 1u : 0u},
                                       {"TWO_SIGNALS", twoSignals() ? 1u : 0u}},
                         .extent = picture_});
        return results;
    }

    gpu::FrameGraph& graph_;
    const DenoiserInput& input_;
    const SvgfStages& svgf_;
    const NanoNetwork& network_;
    const float strength_;
    const bool buffers_;
    const Extent picture_;
    std::array<Extent, NANO_LEVELS> extents_;  ///< with padding
    std::array<ImageHandle, NANO_LEVELS> light_;
    ImageHandle weights_;
};

}  // namespace

ParamTable<NetworkSettings> networkParams(const std::string& method) {
    using S = NetworkSettings;
    ParamTable<S> table(method);
    table.add("strength", &S::strength, 0.0, 1.0, "",
              "Share of the network's result where it would replace SVGF's; 0 is SVGF alone");
    return table;
}

DenoiserOutput recordNetwork(gpu::FrameGraph& graph, const DenoiserInput& input,
                             const FilterSettings& settings, const NanoNetwork& network, float strength) {
    const SvgfStages stages = recordSvgfStages(graph, input, settings.svgf);
    return composeSvgf(graph, input, settings, stages,
                       Recorder(graph, input, stages, network, strength).record());
}

}  // namespace limpid::denoise
