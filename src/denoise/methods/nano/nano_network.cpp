#include "denoise/methods/nano/nano_network.h"

#include <cstring>

#include "base/error.h"
#include "base/half.h"
#include "nano.safetensors.h"

namespace limpid::denoise {
namespace {

constexpr size_t texelBytes = 16;

/// Those that were fastest on an H200 at 1920x1080.
constexpr NanoShares nanoShares{.around = {{{.tiles = 1, .rows = 4, .loops = 4},
                                            {.tiles = 2, .rows = 4},
                                            {.tiles = 3, .rows = 3},
                                            {.tiles = 2, .rows = 2, .small = true},
                                            {.tiles = 1, .rows = 1}}},
                                .point = {{{.tiles = 1, .rows = 8, .small = true},
                                           {.tiles = 2, .rows = 8, .small = true},
                                           {.tiles = 3, .rows = 2},
                                           {.tiles = 4, .rows = 1},
                                           {}}},
                                .halve = {{{},
                                           {.tiles = 2, .rows = 8, .small = true},
                                           {.tiles = 3, .rows = 2},
                                           {.tiles = 2, .rows = 1},
                                           {.tiles = 2, .rows = 1}}}};

/// Places layers one after another, in the order of the file.
class Layout {
  public:
    NanoLayer add(uint32_t inputs, uint32_t coarser, uint32_t outputs, uint32_t taps) {
        const NanoLayer layer{inputs, coarser, outputs, texels_};
        texels_ += outputs + taps * (inputs + coarser) * outputs * NANO_GROUP;
        return layer;
    }
    size_t bytes() const { return texels_ * texelBytes; }

  private:
    uint32_t texels_ = 0;
};

/// The tensors' data, which has so many bytes: a safetensors file begins with the length of its header in
/// eight bytes, and the header. Whole words are embedded.
std::span<const std::byte> dataOf(const std::string& name, std::span<const uint32_t> words, size_t bytes) {
    const std::span<const std::byte> file = std::as_bytes(words);
    uint64_t header = 0;
    if (file.size() >= sizeof(header)) std::memcpy(&header, file.data(), sizeof(header));
    const size_t before = sizeof(header) + header;
    if (header >= file.size() || file.size() < before + bytes ||
        file.size() - before - bytes >= sizeof(uint32_t))
        throw Error("the weights of '" + name + "' do not fit its layers");
    return file.subspan(before, bytes);
}

/// The layer's biases, then the weights of each input, as NanoFinestParams has them.
std::vector<float> byInput(const NanoLayer& layer, std::span<const std::byte> data) {
    std::vector<float> weights;
    const auto append = [&](uint32_t texel) {
        std::array<uint16_t, NANO_GROUP> halves{};
        std::memcpy(halves.data(), &data[(layer.weights + texel) * texelBytes], texelBytes);
        for (const uint16_t half : halves) weights.push_back(halfToFloat(half));
    };
    for (uint32_t group = 0; group < layer.outputs; ++group) append(group);
    for (uint32_t input = 0; input < layer.inputs * NANO_GROUP; ++input) {
        for (uint32_t group = 0; group < layer.outputs; ++group)
            append(layer.outputs + (input / NANO_GROUP * layer.outputs + group) * NANO_GROUP +
                   input % NANO_GROUP);
    }
    return weights;
}

}  // namespace

NanoNetwork makeNanoNetwork(const std::string& name, const NanoShape& shape, const NanoShares& shares,
                            std::span<const uint32_t> file) {
    const auto& [widths, depths] = shape;
    if (widths[0] * NANO_GROUP > NANO_MOST_FINEST)
        throw Error("the finest level of '" + name + "' has more channels than NANO_MOST_FINEST");
    NanoNetwork network{.name = name, .levels = {}, .shares = shares, .weights = {}, .finestLogits = {}};
    Layout layout;
    for (size_t i = 0; i < NANO_LEVELS; ++i) {
        NanoLevel& level = network.levels[i];
        level.halve = i == 0 ? layout.add(NANO_FEATURES / NANO_GROUP, 0, widths[0], 1)
                             : layout.add(widths[i - 1], 0, widths[i], 4);
        for (uint32_t n = 0; n < depths[i]; ++n)
            level.around.push_back(layout.add(widths[i], 0, widths[i], 9));
    }
    for (size_t i = 0; i < NANO_LEVELS; ++i) {
        NanoLevel& level = network.levels[i];
        if (i + 1 < NANO_LEVELS) {
            level.join = layout.add(widths[i], widths[i + 1], widths[i], 1);
            level.after = layout.add(widths[i], 0, widths[i], 9);
        }
        level.logits =
            layout.add(widths[i], 0, 2 * (i == 0 ? NANO_FINEST_LOGIT_GROUPS : NANO_LOGIT_GROUPS), 1);
    }
    const std::span<const std::byte> data = dataOf(name, file, layout.bytes());
    network.weights.assign(data.begin(), data.end());
    constexpr size_t row = NANO_WEIGHTS_WIDTH * texelBytes;
    network.weights.resize((data.size() + row - 1) / row * row);
    network.finestLogits = byInput(network.levels[0].logits, data);
    return network;
}

const NanoNetwork& nanoNetwork() {
    static const NanoNetwork network =
        makeNanoNetwork("nano", {.widths = {2, 4, 6, 8, 8}, .depths = {0, 1, 2, 2, 2}}, nanoShares,
                        embedded::nano_safetensors);
    return network;
}

}  // namespace limpid::denoise
