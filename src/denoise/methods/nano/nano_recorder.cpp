#include "denoise/methods/nano/nano_recorder.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "base/divide_up.h"
#include "denoise/methods/methods.h"
#include "denoise/methods/nano/nano_host.h"
#include "denoise/methods/nano/nano_matrices.h"
#include "denoise/methods/nano/nano_tiles.h"
#include "gpu/graph/elements.h"
#include "nano_convolve.comp.h"
#include "nano_convolve_buffers.comp.h"
#include "nano_features.comp.h"
#include "nano_features_buffers.comp.h"
#include "nano_filter.comp.h"
#include "nano_filter_buffers.comp.h"
#include "nano_finest.comp.h"
#include "nano_finest_buffers.comp.h"
#include "nano_mix.comp.h"
#include "nano_mix_buffers.comp.h"
#include "nano_pool.comp.h"
#include "nano_pool_buffers.comp.h"

namespace limpid::denoise {
namespace {

using gpu::Backing;
using gpu::Extent;
using gpu::Format;
using gpu::ImageHandle;

/// What all tiles of a picture have in common.
struct Picture {
    gpu::FrameGraph& graph;
    const DenoiserInput& input;
    const SvgfStages& svgf;
    const NanoNetwork& network;
    float strength;
    gpu::Extent extent;
    ImageHandle weights, matrixWeights;  ///< matrices read them from a buffer
    ImageHandle stableToo;
    SvgfLight results;
    std::map<std::string, ImageHandle> buffers;  ///< all tiles are of one size, and use the same
};

class TileRecorder {
  public:
    /// `suffix`: of the names of passes.
    TileRecorder(Picture& picture, const NanoTile& tile, const std::string& suffix)
        : picture_(picture),
          graph_(picture.graph),
          input_(picture.input),
          svgf_(picture.svgf),
          network_(picture.network),
          tile_(tile),
          suffix_(suffix),
          buffers_(input_.filters == Backing::Buffer) {
        for (size_t i = 0; i < NANO_LEVELS; ++i)
            extents_[i] = {tile.extent.width >> i, tile.extent.height >> i};
    }

    void record() {
        const ImageHandle first = features();
        if (input_.host) {
            mix(computeOnHost(first));
            return;
        }
        ImageHandle channels = first;
        std::array<ImageHandle, NANO_LEVELS> kept;
        for (size_t i = 0; i < NANO_LEVELS; ++i) {
            const NanoLevel& level = network_.levels[i];
            if (i > 0) channels = convolve(name("halve", i), level.halve, i, NANO_HALVE, channels);
            for (size_t n = 0; n < level.around.size(); ++n)
                channels = convolve(name("around " + std::to_string(i) + "." + std::to_string(n + 1)),
                                    level.around[n], i, NANO_AROUND, channels);
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
        finest(kept[0], result);
    }

  private:
    const gpu::ShaderCode& choose(const gpu::ShaderCode& images, const gpu::ShaderCode& buffers) const {
        return buffers_ ? buffers : images;
    }
    /// Where an invocation computes so many pixels of a row.
    static Extent threads(Extent extent, int pixels) {
        return {divideUp(extent.width, static_cast<uint32_t>(pixels)), extent.height};
    }
    Extent filterThreads(Extent extent) const { return threads(extent, buffers_ ? 1 : NANO_IMAGE_PIXELS); }

    std::string name(const std::string& what) const { return network_.name + "/" + what; }
    std::string name(const std::string& what, size_t level) const {
        return name(what + " " + std::to_string(level));
    }

    /// A buffer with `groups` texels for each pixel of the level.
    ImageHandle texels(const std::string& name, size_t level, uint32_t groups) {
        ImageHandle& buffer = picture_.buffers[name];
        if (!buffer)
            buffer =
                graph_.transient(name, Format::RGBA32Uint,
                                 {extents_[level].width * groups, extents_[level].height}, Backing::Buffer);
        return buffer;
    }

    ImageHandle features() {
        const ImageHandle channels = texels(name("channels"), 0, network_.levels[0].halve.outputs);
        light_[0] = texels(name("light", 0), 0, 1);
        const SvgfSignalStages &a = svgf_.signals.front(), &b = svgf_.signals.back();
        const NanoFeaturesParams params{.camera = input_.camera,
                                        .width = picture_.extent.width,
                                        .height = picture_.extent.height,
                                        .tileX = tile_.x,
                                        .tileY = tile_.y,
                                        .paddedWidth = extents_[0].width,
                                        .paddedHeight = extents_[0].height};
        graph_.dispatch(
            {.pass = name("features") + suffix_,
             .shader = choose(shaders::nano_features_comp, shaders::nano_features_buffers_comp),
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
                          {"weights", picture_.weights},
                          {"channels", channels},
                          {"light", light_[0]}},
             .params = gpu::paramsOf(params),
             .constants = {{"TWO_SIGNALS", twoSignals() ? 1u : 0u},
                           {"HAS_PAST", svgf_.stabilised ? 1u : 0u},
                           {"OUTPUT_GROUPS", network_.levels[0].halve.outputs}},
             .extent = filterThreads(extents_[0])});
        return channels;
    }

    /// The filtered light, in two texels of single precision for each pixel.
    ImageHandle computeOnHost(ImageHandle channels) {
        const ImageHandle light = light_[0], result = texels(name("result"), 0, 2);
        graph_.host({.pass = name("network") + suffix_,
                     .reads = {channels, light},
                     .writes = {result},
                     .run = [host = input_.host, &network = network_,
                             tile = tile_](std::span<const std::span<std::byte>> pixels) {
                         host->run(network, tile, gpu::elementsOf<const uint16_t>(pixels[0]),
                                   gpu::elementsOf<const uint16_t>(pixels[1]),
                                   gpu::elementsOf<float>(pixels[2]));
                     }});
        return result;
    }

    /// Mixes that with SVGF's light.
    void mix(ImageHandle light) {
        const NanoMixParams params{.width = tile_.inner.width,
                                   .height = tile_.inner.height,
                                   .innerX = tile_.innerX,
                                   .innerY = tile_.innerY,
                                   .pitch = extents_[0].width,
                                   .strength = picture_.strength};
        graph_.dispatch({.pass = name("filter", 0) + suffix_,
                         .shader = choose(shaders::nano_mix_comp, shaders::nano_mix_buffers_comp),
                         .bindings = withMixed({{"light", light}}),
                         .params = gpu::paramsOf(params),
                         .constants = mixConstants(),
                         .extent = tile_.inner});
    }

    /// What nano_mix.glsl declares, beside other bindings.
    std::vector<gpu::Binding> withMixed(std::vector<gpu::Binding> bindings) const {
        const SvgfSignalStages &a = svgf_.signals.front(), &b = svgf_.signals.back();
        for (const gpu::Binding& binding : {gpu::Binding{"filteredA", a.filtered},
                                            {"filteredB", b.filtered},
                                            {"resultA", picture_.results[0]},
                                            {"resultB", picture_.results[1]},
                                            {"stableA", a.stable},
                                            {"stableB", picture_.stableToo}})
            bindings.push_back(binding);
        return bindings;
    }

    std::vector<gpu::ConstantValue> mixConstants() const {
        return {{"STABILISE", replacesStable() ? 1u : 0u}, {"TWO_SIGNALS", twoSignals() ? 1u : 0u}};
    }

    /// Without the network's result, SVGF's own stays, which has not been rounded to halves.
    bool replacesStable() const { return svgf_.stabilised && picture_.strength > 0.0f; }

    bool twoSignals() const { return svgf_.signals.size() > 1; }

    const NanoShare& shareOf(size_t level, uint32_t taps) const {
        const NanoShares& shares = network_.shares;
        return (taps == NANO_AROUND  ? shares.around
                : taps == NANO_HALVE ? shares.halve
                                     : shares.point)[level];
    }

    ImageHandle convolve(const std::string& name, const NanoLayer& layer, size_t level, uint32_t taps,
                         ImageHandle inputs, ImageHandle coarser = {}) {
        const ImageHandle outputs = texels(name, level, layer.outputs);
        const std::string pass = name + suffix_;
        const Extent extent = extents_[level];
        const NanoConvolveParams params{.width = extent.width,
                                        .height = extent.height,
                                        .groups = layer.inputs,
                                        .coarserGroups = layer.coarser,
                                        .outputGroups = layer.outputs,
                                        .weights = layer.weights};
        if (!coarser) coarser = inputs;
        if (input_.matrices) {
            convolveByMatrices(graph_, {pass, shareOf(level, taps), taps, params, inputs, coarser,
                                        picture_.matrixWeights, outputs});
            return outputs;
        }
        graph_.dispatch({.pass = pass,
                         .shader = choose(shaders::nano_convolve_comp, shaders::nano_convolve_buffers_comp),
                         .bindings = {{"inputs", inputs},
                                      {"coarser", coarser},
                                      {"weights", picture_.weights},
                                      {"outputs", outputs}},
                         .params = gpu::paramsOf(params),
                         .constants = {{"TAPS", taps}},
                         .extent = threads({extent.width, extent.height * layer.outputs}, NANO_PIXELS)});
        return outputs;
    }

    NanoFilterParams filterParams(size_t level) const {
        const NanoLayer& layer = network_.levels[level].logits;
        const Extent padded = extents_[level], written = level == 0 ? tile_.inner : padded;
        return {.width = written.width,
                .height = written.height,
                .innerX = tile_.innerX,
                .innerY = tile_.innerY,
                .tileX = tile_.x,
                .tileY = tile_.y,
                .paddedWidth = padded.width,
                .paddedHeight = padded.height,
                .groups = layer.inputs,
                .logitGroups = layer.outputs / 2,
                .weights = layer.weights,
                .strength = picture_.strength};
    }

    void pool(size_t level, ImageHandle channels) {
        light_[level + 1] = texels(name("light", level + 1), level + 1, 1);
        const NanoFilterParams params = filterParams(level);
        graph_.dispatch({.pass = name("pool", level + 1) + suffix_,
                         .shader = choose(shaders::nano_pool_comp, shaders::nano_pool_buffers_comp),
                         .bindings = {{"inputs", channels},
                                      {"weights", picture_.weights},
                                      {"light", light_[level]},
                                      {"pooled", light_[level + 1]}},
                         .params = gpu::paramsOf(params),
                         .constants = {{"LOGIT", nanoPoolLogit(level)}},
                         .extent = extents_[level + 1]});
    }

    ImageHandle filter(size_t level, ImageHandle channels, ImageHandle coarser) {
        const ImageHandle result = texels(name("filtered", level), level, 1);
        const NanoFilterParams params = filterParams(level);
        graph_.dispatch({.pass = name("filter", level) + suffix_,
                         .shader = choose(shaders::nano_filter_comp, shaders::nano_filter_buffers_comp),
                         .bindings = {{"inputs", channels},
                                      {"weights", picture_.weights},
                                      {"light", light_[level]},
                                      {"coarser", coarser ? coarser : light_[level]},
                                      {"result", result}},
                         .params = gpu::paramsOf(params),
                         .constants = {{"COARSER", coarser ? 1u : 0u}},
                         .extent = filterThreads(extents_[level])});
        return result;
    }

    void finest(ImageHandle channels, ImageHandle coarser) {
        NanoFinestParams params{.level = filterParams(0), .logits = {}};
        std::ranges::copy(network_.finestLogits, params.logits);
        std::vector<gpu::ConstantValue> constants = mixConstants();
        constants.push_back({"INPUT_GROUPS", network_.levels[0].logits.inputs});
        graph_.dispatch(
            {.pass = name("filter", 0) + suffix_,
             .shader = choose(shaders::nano_finest_comp, shaders::nano_finest_buffers_comp),
             .bindings = withMixed({{"inputs", channels}, {"light", light_[0]}, {"coarser", coarser}}),
             .params = gpu::paramsOf(params),
             .constants = constants,
             .extent = filterThreads(tile_.inner)});
    }

    Picture& picture_;
    gpu::FrameGraph& graph_;
    const DenoiserInput& input_;
    const SvgfStages& svgf_;
    const NanoNetwork& network_;
    const NanoTile& tile_;
    const std::string suffix_;
    const bool buffers_;
    std::array<Extent, NANO_LEVELS> extents_;
    std::array<ImageHandle, NANO_LEVELS> light_;
};

Picture pictureOf(gpu::FrameGraph& graph, const DenoiserInput& input, const SvgfStages& svgf,
                  const NanoNetwork& network, float strength) {
    const Extent extent = graph.extent(svgf.signals.front().filtered);
    const auto image = [&](const std::string& called) {
        return graph.transient(network.name + "/" + called, Format::RGBA16Float, extent, input.filters);
    };
    const auto weightsIn = [&](const std::string& called, Backing backing) {
        const auto rows = static_cast<uint32_t>(network.weights.size() / 16 / NANO_WEIGHTS_WIDTH);
        const ImageHandle weights = graph.transient(network.name + "/" + called, Format::RGBA32Uint,
                                                    {NANO_WEIGHTS_WIDTH, rows}, backing);
        graph.upload(weights, network.weights);
        return weights;
    };
    const ImageHandle weights = weightsIn("weights", input.filters);
    const bool others = input.matrices && input.filters == Backing::Image;
    const ImageHandle stableToo =
        svgf.signals.size() > 1
            ? svgf.signals.back().stable
            : graph.transient(network.name + "/no second", Format::R32Uint, {1, 1}, input.filters);
    return {.graph = graph,
            .input = input,
            .svgf = svgf,
            .network = network,
            .strength = strength,
            .extent = extent,
            .weights = weights,
            .matrixWeights = others ? weightsIn("weights of matrices", Backing::Buffer) : weights,
            .stableToo = stableToo,
            .results = {image("diffuse"), image("specular")},
            .buffers = {}};
}

/// Channels of the finest level, which take most, fit in a buffer. One tile if none is small enough, so that
/// what executes the graph says that a buffer is too large.
std::vector<NanoTile> tilesOf(const Picture& picture) {
    constexpr uint64_t bytesOfGroup = 16;
    const uint64_t bytesOfPixel = bytesOfGroup * picture.network.levels[0].halve.outputs;
    const uint32_t reach = nanoReach(picture.network);
    uint64_t most = picture.input.largestBuffer / bytesOfPixel;
    if (picture.input.host)
        most = std::min(most, NanoHost::mostBytes / NanoHost::bytesOfPixel(picture.network));
    std::vector<NanoTile> tiles = nanoTiles(picture.extent, reach, most);
    return tiles.empty() ? nanoTiles(picture.extent, reach, UINT64_MAX) : tiles;
}

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
    Picture picture = pictureOf(graph, input, stages, network, strength);
    const std::vector<NanoTile> tiles = tilesOf(picture);
    for (size_t i = 0; i < tiles.size(); ++i) {
        const std::string suffix =
            tiles.size() == 1 ? "" : ", " + std::to_string(i + 1) + " of " + std::to_string(tiles.size());
        TileRecorder(picture, tiles[i], suffix).record();
    }
    return composeSvgf(graph, input, settings, stages, picture.results);
}

}  // namespace limpid::denoise
