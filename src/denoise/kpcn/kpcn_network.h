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
    Half,      ///< weights and channels in half precision
    Matrices,  ///< half precision, multiplied by cooperative matrices
    Host       ///< in single precision by the host, with oneDNN: on CPUs, where Limpid was built with it
};
std::string_view toString(KpcnPrecision precision);

/// Returns the fastest precision that the device supports. Without `half`, GPUs use Float.
KpcnPrecision kpcnPrecision(const gpu::DeviceInfo& device, bool half);

/// The weights in the order in which the passes read them. Indices from the slowest to the fastest: slab of
/// 16 inputs, tap, input within the slab, output (padded to whole slabs). Every layer has one additional
/// input that is always 1; its weights at the centre tap are the bias. Hidden layers have an additional
/// output that produces this 1 for the next layer.
class KpcnNetwork {
  public:
    KpcnNetwork(gpu::Device& device, const KpcnWeights& weights, KpcnPrecision precision);

    struct Layer {
        uint32_t inputSlabs, outputTiles;  ///< number of slabs of 16 channels
        uint32_t weights;                  ///< offset in the buffer, in units of 8
    };
    /// 0: diffuse, 1: specular. Hidden layers, then the output.
    const std::vector<Layer>& layers(size_t side) const { return layers_[side]; }
    const gpu::Buffer& weights() const { return buffer_; }
    /// Only for KpcnPrecision::Host.
    KpcnHost& host() const { return *host_; }
    KpcnPrecision precision() const { return precision_; }
    uint32_t kernelWidth() const { return kernelWidth_; }
    /// Same as KpcnWeights::facing.
    float facing() const { return facing_; }
    /// Same as KpcnWeights::logarithmicDiffuse.
    bool logarithmicDiffuse() const { return logarithmicDiffuse_; }
    /// Maximum over inputs and hidden layers.
    uint32_t slabs() const { return slabs_; }
    /// Maximum size of a buffer on the device, bytes.
    uint64_t maxBytes() const { return maxBytes_; }

  private:
    KpcnPrecision precision_;
    uint32_t kernelWidth_, slabs_;
    float facing_;
    bool logarithmicDiffuse_;
    uint64_t maxBytes_;
    std::array<std::vector<Layer>, 2> layers_;
    gpu::Buffer buffer_;
    std::unique_ptr<KpcnHost> host_;
};

}  // namespace limpid::denoise
