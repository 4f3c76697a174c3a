#include "denoise/kpcn/kpcn_network.h"

#include <algorithm>

#include "denoise/kpcn/kpcn_params.h"
#include "neural/tensor_file.h"

namespace limpid::denoise {
namespace {

constexpr uint32_t taps = KPCN_TAPS * KPCN_TAPS, centre = taps / 2;

uint32_t slabsOf(uint32_t channels) {
    return (channels + KPCN_SLAB - 1) / KPCN_SLAB;
}

/// Appends a layer's weights to `packed` in the order that KpcnNetwork describes. `hidden`: adds an output
/// that is always 1, the next layer's bias channel.
void pack(const KpcnLayer& layer, bool hidden, std::vector<float>& packed) {
    const uint32_t outputs = slabsOf(layer.outputs + (hidden ? 1 : 0)) * KPCN_SLAB;
    const size_t begin = packed.size();
    packed.resize(begin + size_t{slabsOf(layer.inputs + 1)} * taps * KPCN_SLAB * outputs);
    const auto place = [&](uint32_t input, uint32_t tap, uint32_t output) -> float& {
        const size_t line = (size_t{input / KPCN_SLAB} * taps + tap) * KPCN_SLAB + input % KPCN_SLAB;
        return packed[begin + line * outputs + output];
    };
    for (uint32_t output = 0; output < layer.outputs; ++output) {
        for (uint32_t input = 0; input < layer.inputs; ++input) {
            for (uint32_t tap = 0; tap < taps; ++tap)
                place(input, tap, output) =
                    layer.weights[(size_t{output} * layer.inputs + input) * taps + tap];
        }
        place(layer.inputs, centre, output) = layer.bias[output];
    }
    if (hidden) place(layer.inputs, centre, layer.outputs) = 1.0f;
}

}  // namespace

std::string_view toString(KpcnPrecision precision) {
    switch (precision) {
        case KpcnPrecision::Float:
            return "single precision";
        case KpcnPrecision::Half:
            return "half precision";
        case KpcnPrecision::Matrices:
            return "half precision, cooperative matrices";
        case KpcnPrecision::Host:
            return "single precision, oneDNN";
    }
    return "";
}

KpcnPrecision kpcnPrecision(const gpu::DeviceInfo& device, bool half) {
    if (device.type == gpu::DeviceType::Cpu && kpcnHostAvailable()) return KpcnPrecision::Host;
    if (!half) return KpcnPrecision::Float;
    return device.cooperativeMatrices ? KpcnPrecision::Matrices : KpcnPrecision::Half;
}

KpcnNetwork::KpcnNetwork(gpu::Device& device, const KpcnWeights& weights, KpcnPrecision precision)
    : precision_(precision),
      kernelWidth_(weights.kernelWidth),
      slabs_(KPCN_INPUT_SLABS),
      facing_(weights.facing),
      logarithmicDiffuse_(weights.logarithmicDiffuse),
      maxBytes_(device.maxStorageBufferBytes()) {
    std::vector<float> packed;
    for (size_t side = 0; side < 2; ++side) {
        for (const KpcnLayer& layer : weights.sides[side]) {
            const bool hidden = &layer != &weights.sides[side].back();
            const Layer made{slabsOf(layer.inputs + 1), slabsOf(layer.outputs + (hidden ? 1 : 0)),
                             static_cast<uint32_t>(packed.size() / 8)};
            pack(layer, hidden, packed);
            layers_[side].push_back(made);
            slabs_ = std::max(slabs_, made.inputSlabs);
        }
    }
    if (precision == KpcnPrecision::Host) {
        host_ = std::make_unique<KpcnHost>(weights);
        slabs_ = KPCN_INPUT_SLABS;
        return;
    }
    const auto type =
        precision == KpcnPrecision::Float ? neural::ElementType::Float32 : neural::ElementType::Float16;
    const neural::Tensor tensor = neural::makeTensor(type, {packed.size()}, packed);
    buffer_ = device.createStorageBuffer("kpcn weights", tensor.bytes);
}

}  // namespace limpid::denoise
