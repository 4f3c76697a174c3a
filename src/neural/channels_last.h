// Single convolutions on the CPU, using oneDNN. Only built if CMake found it (LIMPID_HAVE_ONEDNN).
#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace limpid::neural {

struct ConvolutionShape {
    uint32_t inputs = 0, outputs = 0;
    uint32_t taps = 1;    ///< of a side; an odd number takes pixels around, and zeros beyond the edges
    uint32_t stride = 1;  ///< from one pixel of the result to the next, in the input
    uint32_t columns = 0, rows = 0;  ///< of the input
    bool adds = false;               ///< to what is in the result
    float slope = 1.0f;              ///< what negative results are multiplied by
};

/// A convolution of pictures of one size, in single precision. The channels of a pixel lie side by side.
class ChannelsLastConvolution {
  public:
    /// Weights (outputs, inputs, taps, taps), and biases (outputs); no biases are zeros. Throws Error if they
    /// are of another size.
    ChannelsLastConvolution(const ConvolutionShape& shape, std::span<const float> weights,
                            std::span<const float> biases);
    ~ChannelsLastConvolution();
    ChannelsLastConvolution(ChannelsLastConvolution&&) noexcept;
    ChannelsLastConvolution& operator=(ChannelsLastConvolution&&) noexcept;

    /// Sizes: rows x columns x inputs, and rows / stride x columns / stride x outputs. Throws Error if they
    /// are others.
    void run(std::span<const float> input, std::span<float> result);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace limpid::neural
