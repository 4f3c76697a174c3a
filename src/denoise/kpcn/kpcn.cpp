#include "denoise/kpcn/kpcn.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>

#include "base/divide_up.h"
#include "base/error.h"
#include "denoise/kpcn/kpcn_params.h"
#include "denoise/stages/atrous/levels.h"
#include "denoise/stages/compose/compose.h"
#include "gpu/graph/elements.h"
#include "kpcn_distances.comp.h"
#include "kpcn_features.comp.h"
#include "kpcn_features_float.comp.h"
#include "kpcn_hidden.comp.h"
#include "kpcn_hidden_float.comp.h"
#include "kpcn_hidden_matrix.comp.h"
#include "kpcn_kernel.comp.h"
#include "kpcn_kernel_float.comp.h"
#include "kpcn_kernel_matrix.comp.h"
#include "kpcn_largest.comp.h"
#include "kpcn_level.comp.h"
#include "kpcn_level_buffers.comp.h"
#include "kpcn_limit.comp.h"
#include "kpcn_limit_buffers.comp.h"

namespace limpid::denoise {
namespace {

using gpu::Backing;
using gpu::Extent;
using gpu::Format;
using gpu::FrameGraph;
using gpu::ImageHandle;

constexpr uint32_t minSamplesForErrors = 8;
constexpr const char* sideNames[] = {"diffuse", "specular"};
constexpr uint32_t reach = KPCN_TAPS / 2;
constexpr uint32_t block = 4;         // pixels per invocation of kpcn_convolve.glsl
constexpr uint32_t workgroup = 16;    // edge length of a workgroup of kpcn_matrix.glsl in pixels
constexpr uint32_t alignment = 16;    // sizes of tiles are multiples of this, in pixels
constexpr uint32_t texelsOfSlab = 4;  // texels of one pixel in one slab

/// Distances between the taps of the filter levels after the network, in pixels, from the last level to the
/// first. The last level must read direct neighbours: without it, odd and even pixels would be filtered
/// separately.
constexpr uint32_t levelSteps[] = {1, 2, 8, 32, 128, 512};

uint32_t stepOf(int left) {
    return levelSteps[left - 1];
}

/// The shaders for one precision. (KpcnPrecision::Host uses only `features`, in single precision.)
struct Shaders {
    const gpu::ShaderCode &features, &hidden, &kernel;
    Format format;        ///< of a texel, which holds four channels
    uint32_t texelBytes;  ///< size of a texel
    uint32_t width;       ///< pixels per invocation
};

const Shaders& shadersOf(KpcnPrecision precision) {
    static const Shaders single{shaders::kpcn_features_float_comp,
                                shaders::kpcn_hidden_float_comp,
                                shaders::kpcn_kernel_float_comp,
                                Format::RGBA32Float,
                                16,
                                block};
    static const Shaders half{shaders::kpcn_features_comp,
                              shaders::kpcn_hidden_comp,
                              shaders::kpcn_kernel_comp,
                              Format::RG32Uint,
                              8,
                              block};
    static const Shaders matrices{shaders::kpcn_features_comp,
                                  shaders::kpcn_hidden_matrix_comp,
                                  shaders::kpcn_kernel_matrix_comp,
                                  Format::RG32Uint,
                                  8,
                                  1};
    switch (precision) {
        case KpcnPrecision::Half:
            return half;
        case KpcnPrecision::Matrices:
            return matrices;
        default:
            return single;
    }
}

/// Returns the largest divisor of `count` that is at most `max`.
uint32_t divisor(uint32_t count, uint32_t max) {
    for (uint32_t d = max; d > 1; --d) {
        if (count % d == 0) return d;
    }
    return 1;
}

struct Tile {
    uint32_t left, top, width, height;
};

class Recorder {
  public:
    Recorder(FrameGraph& graph, const DenoiserInput& input, const KpcnSettings& settings,
             const KpcnNetwork& network)
        : graph_(graph),
          input_(input),
          network_(network),
          shaders_(shadersOf(network_.precision())),
          settings_(settings),
          picture_(graph.extent(input.depth)) {
        const auto hidden = static_cast<uint32_t>(network_.layers(0).size()) - 1;
        margin_ = std::max(reach * (hidden + 1), network_.kernelWidth() / 2);
        tile_ = tileSize(static_cast<uint32_t>(settings.tile));
        pitch_ = bufferSize(tile_.width, picture_.width);
        rows_ = bufferSize(tile_.height, picture_.height);
    }

    ImageHandle run() {
        const ImageHandle largest = largestDistance();
        const Extent channels{pitch_ * texelsOfSlab, rows_ * network_.slabs()};
        for (size_t i = 0; i < (onHost() ? 1 : 2); ++i)
            channels_[i] = graph_.transient("kpcn/channels " + std::to_string(i + 1), shaders_.format,
                                            channels, Backing::Buffer);
        light_ = graph_.transient("kpcn/light", Format::RGBA32Float, {pitch_, rows_}, Backing::Buffer);
        faces_ = graph_.transient("kpcn/faces", Format::R32Uint, {pitch_, rows_}, Backing::Buffer);
        std::array<ImageHandle, 2> clean;
        for (size_t side = 0; side < 2; ++side) {
            clean[side] = graph_.transient(std::string("kpcn/") + sideNames[side], Format::RGBA32Float,
                                           picture_, onHost() ? Backing::Buffer : Backing::Image);
            for (uint32_t top = 0; top < picture_.height; top += tile_.height) {
                for (uint32_t left = 0; left < picture_.width; left += tile_.width)
                    recordTile(side,
                               {left, top, std::min(tile_.width, picture_.width - left),
                                std::min(tile_.height, picture_.height - top)},
                               largest, clean[side]);
            }
            clean[side] = levels(side, clean[side]);
        }
        return compose(graph_, "kpcn/compose",
                       {.light = limit(clean), .albedo = input_.albedo, .emission = input_.emission});
    }

  private:
    /// Divides the picture into tiles of about equal size, at most `wanted` pixels along an edge, and small
    /// enough for the device's buffers.
    Extent tileSize(uint32_t wanted) const {
        const auto part = [&](uint32_t length, uint32_t max) {
            const uint32_t even = divideUp(length, divideUp(length, max));
            return std::min(divideUp(even, alignment) * alignment, divideUp(length, alignment) * alignment);
        };
        uint32_t edge = std::max(divideUp(wanted, alignment) * alignment, alignment);
        while (true) {
            const Extent tile{part(picture_.width, edge), part(picture_.height, edge)};
            const uint64_t bytes = uint64_t{bufferSize(tile.width, picture_.width)} *
                                   bufferSize(tile.height, picture_.height) * network_.slabs() *
                                   texelsOfSlab * shaders_.texelBytes;
            if (bytes <= network_.maxBytes() || edge == alignment) return tile;
            edge -= alignment;
        }
    }

    /// Returns the edge length of a tile's buffers: the tile, the margin on both sides, and the pixels that
    /// the last workgroups compute beyond that.
    uint32_t bufferSize(uint32_t tile, uint32_t picture) const {
        return std::min(tile + 2 * margin_, divideUp(picture, alignment) * alignment) + workgroup;
    }

    /// Returns the tile with `margin` pixels around it, clipped to the picture. The buffers begin `margin_`
    /// pixels before the tile, or at the picture's edge.
    KpcnRegion region(const Tile& tile, uint32_t margin) const {
        const auto begin = [](uint32_t at, uint32_t around) {
            return static_cast<int>(at - std::min(at, around));
        };
        KpcnRegion r{};
        r.left = begin(tile.left, margin);
        r.top = begin(tile.top, margin);
        r.width = static_cast<int>(std::min(tile.left + tile.width + margin, picture_.width)) - r.left;
        r.height = static_cast<int>(std::min(tile.top + tile.height + margin, picture_.height)) - r.top;
        r.originX = begin(tile.left, margin_);
        r.originY = begin(tile.top, margin_);
        r.pitch = onHost() ? r.width : static_cast<int>(pitch_);  // the host needs rows without gaps
        r.rows = onHost() ? r.height : static_cast<int>(rows_);
        r.pictureWidth = static_cast<int>(picture_.width);
        r.pictureHeight = static_cast<int>(picture_.height);
        return r;
    }

    Extent invocations(const KpcnRegion& r, uint32_t width) const {
        return {divideUp(static_cast<uint32_t>(r.width), width), static_cast<uint32_t>(r.height)};
    }

    ImageHandle largestDistance() {
        ImageHandle image = graph_.transient("kpcn/distances", Format::R32Float, picture_);
        const auto sizeOf = [](Extent e) {
            return KpcnReduceParams{static_cast<int>(e.width), static_cast<int>(e.height)};
        };
        graph_.dispatch({.pass = "kpcn/distances",
                         .shader = shaders::kpcn_distances_comp,
                         .bindings = {{"depth", input_.depth}, {"distances", image}},
                         .params = gpu::paramsOf(sizeOf(picture_)),
                         .constants = {},
                         .extent = picture_});
        for (Extent extent = picture_; extent != Extent{1, 1};) {
            const Extent smaller{divideUp(extent.width, 8), divideUp(extent.height, 8)};
            const ImageHandle next = graph_.transient(
                "kpcn/largest of " + std::to_string(smaller.width) + "x" + std::to_string(smaller.height),
                Format::R32Float, smaller);
            graph_.dispatch({.pass = "kpcn/largest",
                             .shader = shaders::kpcn_largest_comp,
                             .bindings = {{"source", image}, {"largest", next}},
                             .params = gpu::paramsOf(sizeOf(extent)),
                             .constants = {},
                             .extent = smaller});
            image = next;
            extent = smaller;
        }
        return image;
    }

    void recordTile(size_t side, const Tile& tile, ImageHandle largest, ImageHandle clean) {
        const std::string prefix = std::string("kpcn/") + sideNames[side] + " ";
        features(side, tile, largest, prefix);
        if (onHost()) return layersOnHost(side, tile, clean, prefix);
        const std::vector<KpcnNetwork::Layer>& layers = network_.layers(side);
        for (size_t i = 0; i + 1 < layers.size(); ++i) {
            const KpcnRegion where = region(tile, reach * static_cast<uint32_t>(layers.size() - 1 - i));
            dispatchLayer(prefix + "hidden " + std::to_string(i + 1), shaders_.hidden, layers[i], where, 8,
                          {{"inputs", channels_[i % 2]}, {"outputs", channels_[(i + 1) % 2]}});
        }
        dispatchLayer(prefix + "kernel", shaders_.kernel, layers.back(), region(tile, 0), 4,
                      {{"inputs", channels_[(layers.size() - 1) % 2]},
                       {"light", light_},
                       {"faces", faces_},
                       {"clean", clean}});
    }

    /// Returns the number of filter levels. Levels with taps further apart than a tenth of the shorter edge
    /// are skipped, because flat areas are small in small pictures.
    int levelCount() const {
        const uint32_t widest = std::max(1u, std::min(picture_.width, picture_.height) / 10);
        int count = settings_.levels;
        while (count > 0 && stepOf(count) > widest) --count;
        return count;
    }

    /// Records the filter levels. The widest comes first, while there is most noise: a level tolerates
    /// differences of luminance in proportion to the noise that is left.
    ImageHandle levels(size_t side, ImageHandle clean) {
        const int count = levelCount();
        for (int i = 0; i < count; ++i) {
            const std::string name =
                std::string("kpcn/") + sideNames[side] + " level " + std::to_string(i + 1);
            const ImageHandle next = graph_.transient(name, Format::RGBA32Float, picture_,
                                                      onHost() ? Backing::Buffer : Backing::Image);
            const int step = static_cast<int>(stepOf(count - i));
            const KpcnLevelParams params{static_cast<int>(picture_.width), static_cast<int>(picture_.height),
                                         step, settings_.phiColor, static_cast<uint32_t>(side)};
            graph_.dispatch({.pass = name,
                             .shader = onHost() ? shaders::kpcn_level_buffers_comp : shaders::kpcn_level_comp,
                             .bindings = {{"clean", clean},
                                          {"filtered", next},
                                          {"normal", input_.normal},
                                          {"depth", input_.depth},
                                          {"albedo", input_.albedo}},
                             .params = gpu::paramsOf(params),
                             .constants = {},
                             .extent = levelInvocations(picture_, step, {1, 1})});
            clean = next;
        }
        return clean;
    }

    bool onHost() const { return network_.precision() == KpcnPrecision::Host; }

    void layersOnHost(size_t side, const Tile& tile, ImageHandle clean, const std::string& prefix) {
        const KpcnRegion whole = region(tile, margin_);
        const KpcnHostTile part{static_cast<uint32_t>(whole.width),
                                static_cast<uint32_t>(whole.height),
                                tile.left - static_cast<uint32_t>(whole.left),
                                tile.top - static_cast<uint32_t>(whole.top),
                                tile.width,
                                tile.height};
        const size_t first = 4 * (size_t{tile.top} * picture_.width + tile.left);
        graph_.host({.pass = prefix + "layers",
                     .reads = {channels_[0], light_, faces_},
                     .writes = {clean},
                     .run = [&host = network_.host(), side, part, first,
                             pitch = picture_.width](std::span<const std::span<std::byte>> pixels) {
                         host.run(side, part, gpu::elementsOf<float>(pixels[0]),
                                  gpu::elementsOf<float>(pixels[1]), gpu::elementsOf<uint32_t>(pixels[2]),
                                  gpu::elementsOf<float>(pixels[3]).subspan(first), pitch);
                     }});
    }

    float ofMean() const { return input_.samples > 1 ? 1.0f / static_cast<float>(input_.samples - 1) : 0.0f; }

    void features(size_t side, const Tile& tile, ImageHandle largest, const std::string& prefix) {
        const bool logarithmic = side == 1 || network_.logarithmicDiffuse();
        const KpcnFeaturesParams params{region(tile, margin_), ofMean(), static_cast<uint32_t>(side),
                                        logarithmic};
        graph_.dispatch({.pass = prefix + "features",
                         .shader = shaders_.features,
                         .bindings = {{"radiance", side == 0 ? input_.diffuse : input_.specular},
                                      {"albedo", input_.albedo},
                                      {"normal", input_.normal},
                                      {"depth", input_.depth},
                                      {"largest", largest},
                                      {"features", channels_[0]},
                                      {"light", light_},
                                      {"faces", faces_}},
                         .params = gpu::paramsOf(params),
                         .constants = {},
                         .extent = invocations(params.region, 1)});
    }

    void dispatchLayer(const std::string& pass, const gpu::ShaderCode& shader,
                       const KpcnNetwork::Layer& layer, const KpcnRegion& where, uint32_t maxTiles,
                       std::vector<gpu::Binding> bindings) {
        const KpcnLayerParams params{where,         layer.inputSlabs,       layer.outputTiles,
                                     layer.weights, network_.kernelWidth(), network_.facing()};
        bindings.push_back({"weights", &network_.weights()});
        std::vector<gpu::ConstantValue> constants;
        if (network_.precision() == KpcnPrecision::Matrices)
            constants.push_back({"TILES", divisor(layer.outputTiles, maxTiles)});
        graph_.dispatch({.pass = pass,
                         .shader = shader,
                         .bindings = std::move(bindings),
                         .params = gpu::paramsOf(params),
                         .constants = std::move(constants),
                         .extent = invocations(where, shaders_.width)});
    }

    ImageHandle limit(const std::array<ImageHandle, 2>& clean) {
        const ImageHandle scattered = graph_.transient("kpcn/scattered", Format::RGBA32Float, picture_);
        // Few samples say little about their error: it is 0 for a light that all of them missed.
        const KpcnLimitParams params{static_cast<int>(picture_.width), static_cast<int>(picture_.height),
                                     ofMean(),
                                     input_.samples >= minSamplesForErrors ? settings_.standardErrors : 0.0f};
        graph_.dispatch({.pass = "kpcn/limit",
                         .shader = onHost() ? shaders::kpcn_limit_buffers_comp : shaders::kpcn_limit_comp,
                         .bindings = {{"diffuse", clean[0]},
                                      {"specular", clean[1]},
                                      {"albedo", input_.albedo},
                                      {"noisyDiffuse", input_.diffuse},
                                      {"noisySpecular", input_.specular},
                                      {"scattered", scattered}},
                         .params = gpu::paramsOf(params),
                         .constants = {},
                         .extent = picture_});
        return scattered;
    }

    FrameGraph& graph_;
    const DenoiserInput& input_;
    const KpcnNetwork& network_;
    const Shaders& shaders_;
    const KpcnSettings& settings_;
    Extent picture_;
    uint32_t margin_ = 0;  ///< pixels around a tile for which features are computed
    Extent tile_;
    uint32_t pitch_ = 0, rows_ = 0;  ///< size of the buffers in pixels
    std::array<ImageHandle, 2> channels_;
    ImageHandle light_, faces_;
};

}  // namespace

const ParamTable<KpcnSettings>& kpcnParams() {
    static const auto table = [] {
        using S = KpcnSettings;
        ParamTable<S> t("kpcn");
        t.add("tile", &S::tile, 16, 16384, "pixels",
              "Edge of the tiles in which a picture is denoised; larger is a little faster and takes more "
              "memory")
            .slider(64, 4096, SliderScale::Logarithmic);
        t.add("errors", &S::standardErrors, 0.0, 100.0, "standard errors",
              "Maximum deviation of clean from noisy light; lower keeps sharp reflections and small lights, "
              "higher removes fireflies; 0 is no limit. Does not apply where neighbours agree with the "
              "network")
            .slider(0, 20);
        t.add("levels", &S::levels, 0, static_cast<int>(std::size(levelSteps)), "levels",
              "Filter passes after the network, for flat areas; the last reads direct neighbours, the one "
              "before at 2 pixels, each earlier one four times as far; passes wider than a tenth of the "
              "shorter edge are skipped; more is smoother");
        t.add("phi_color", &S::phiColor, 1e-6, 1e9, "standard errors",
              "Difference of luminance that the filter passes tolerate; higher is smoother and blurs soft "
              "shadows");
        t.add("half", &S::half, "Half precision; off: single precision, slower");
        t.add("cis565", &S::cis565,
              "Use the shipped network trained as the course CIS 565 describes (docs/kpcn.md); off: Limpid's "
              "own, which is better");
        return t;
    }();
    return table;
}

ImageHandle filterKpcn(FrameGraph& graph, const DenoiserInput& input, const KpcnSettings& settings,
                       const KpcnNetwork& network) {
    return Recorder(graph, input, settings, network).run();
}

}  // namespace limpid::denoise
