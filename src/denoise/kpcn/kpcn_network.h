// A kernel-predicting network on a device, ready for its passes.
#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "denoise/kpcn/kpcn_host.h"
#include "denoise/kpcn/kpcn_weights.h"
#include "gpu/vulkan/device.h"

namespace limpid::denoise {

/// How a network is computed. Sums are always in single precision.
enum class KpcnPrecision {
    Float,     ///< weights and channels in single precision
    Half,      ///< ... in half precision
    Matrices,  ///< ... multiplied by cooperative matrices
    Host       ///< in single precision by the host, with oneDNN: on CPUs, where Limpid was built with it
};
std::string_view toString(KpcnPrecision precision);

/// The fastest that the device has; of GPUs Float unless `half`.
KpcnPrecision kpcnPrecision(const gpu::DeviceInfo& device, bool half);

/// The weights in the order in which the passes read them: of each slab of 16 inputs, of each tap, of each
/// input, all outputs, as many as make whole slabs. The input after the last is always 1: its weights at the
/// centre are the bias. Hidden layers pass it on.
class KpcnNetwork {
  public:
    KpcnNetwork(gpu::Device& device, const KpcnWeights& weights, KpcnPrecision precision);

    struct Layer {
        uint32_t inputSlabs, outputTiles;  ///< of 16 channels
        uint32_t weights;                  ///< where they begin in the buffer, by 8
    };
    /// 0: diffuse, 1: specular. Hidden layers, then the output.
    const std::vector<Layer>& layers(size_t side) const { return layers_[side]; }
    const gpu::Buffer& weights() const { return buffer_; }
    /// Of KpcnPrecision::Host.
    KpcnHost& host() const { return *host_; }
    KpcnPrecision precision() const { return precision_; }
    uint32_t kernelWidth() const { return kernelWidth_; }
    /// KpcnWeights::facing.
    float facing() const { return facing_; }
    /// Of hidden layers and inputs, the most.
    uint32_t slabs() const { return slabs_; }
    /// Bytes that one buffer may have on the device.
    uint64_t maxBytes() const { return maxBytes_; }

  private:
    KpcnPrecision precision_;
    uint32_t kernelWidth_, slabs_;
    float facing_;
    uint64_t maxBytes_;
    std::array<std::vector<Layer>, 2> layers_;
    gpu::Buffer buffer_;
    std::unique_ptr<KpcnHost> host_;
};

}  // namespace limpid::denoise
