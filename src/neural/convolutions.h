// Convolutions of 5x5 taps on the CPU, using oneDNN. Only built if CMake found it (LIMPID_HAVE_ONEDNN).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace limpid::neural {

/// Weights (outputs, inputs, 5, 5) and bias (outputs); `relu`: negative values become 0.
struct ConvolutionLayer {
    uint32_t inputs = 0, outputs = 0;
    std::span<const float> weights, bias;
    bool relu = false;
};

/// Runs layers one after the other in single precision, on pictures of any size. Weights are prepared once;
/// primitives and buffers of the last size are kept. The last layer is computed some rows at a time, since it
/// may have many channels.
class ConvolutionChain {
  public:
    /// Needs at least one layer; each has as many inputs as the one before has outputs.
    explicit ConvolutionChain(const std::vector<ConvolutionLayer>& layers);
    ~ConvolutionChain();
    ConvolutionChain(const ConvolutionChain&) = delete;
    ConvolutionChain& operator=(const ConvolutionChain&) = delete;

    /// `input`: blocks of 16 channels, each rows x columns x 16; channels beyond the first layer's inputs are
    /// ignored. It is padded with zeros. rows() then computes the last layer for rows `first` to `first` +
    /// `count` - 1.
    void begin(std::span<const float> input, uint32_t columns, uint32_t rows);
    /// Returns (channels, count, columns), valid until the next call; the caller may overwrite them.
    std::span<float> rows(uint32_t first, uint32_t count);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace limpid::neural
