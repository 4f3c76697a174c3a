#include "denoise/methods/nano/nano_network.h"

#include <cstring>

#include "base/error.h"
#include "nano.safetensors.h"

namespace limpid::denoise {
namespace {

constexpr size_t texelBytes = 16;

/// The number of channels of each level, in groups, and of its layers on the way down.
constexpr std::array<uint32_t, NANO_LEVELS> widths{2, 4, 6, 8, 8};
constexpr std::array<uint32_t, NANO_LEVELS> depths{0, 1, 2, 2, 2};

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
std::span<const std::byte> dataOf(std::span<const uint32_t> words, size_t bytes) {
    const std::span<const std::byte> file = std::as_bytes(words);
    uint64_t header = 0;
    if (file.size() >= sizeof(header)) std::memcpy(&header, file.data(), sizeof(header));
    const size_t before = sizeof(header) + header;
    if (header >= file.size() || file.size() < before + bytes ||
        file.size() - before - bytes >= sizeof(uint32_t))
        throw Error("the weights of 'nano' do not fit its layers");
    return file.subspan(before, bytes);
}

NanoNetwork makeNetwork() {
    NanoNetwork network;
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
    network.weights = dataOf(embedded::nano_safetensors, layout.bytes());
    return network;
}

}  // namespace

const NanoNetwork& nanoNetwork() {
    static const NanoNetwork network = makeNetwork();
    return network;
}

}  // namespace limpid::denoise
