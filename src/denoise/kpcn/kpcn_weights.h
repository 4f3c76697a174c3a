// Weights of the kernel-predicting network from a file that training/limpid_training/export.py wrote
// (docs/kpcn.md, "Files").
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/progress.h"

namespace limpid::denoise {

/// A convolution of 5x5 taps.
struct KpcnLayer {
    uint32_t inputs = 0, outputs = 0;  ///< channels
    std::vector<float> weights;        ///< (outputs, inputs, 5, 5)
    std::vector<float> bias;           ///< (outputs)
};

struct KpcnWeights {
    uint32_t kernelWidth = 0;                     ///< pixels; odd
    std::array<std::vector<KpcnLayer>, 2> sides;  ///< diffuse, specular: hidden layers, then the output
    /// Minimum cosine between a pixel's normal and those of the pixels that its kernel averages; -2: no
    /// condition. It belongs to the network because it applies in training, too.
    float facing = 0.5f;
    /// The network for diffuse light sees log(1 + light); if false, the light itself.
    bool logarithmicDiffuse = true;
};

/// Throws InputError for a file that cannot be read, is damaged (neural/tensor_file.h), is not such a
/// network, has missing, additional or other tensors than its shape says, or contains numbers that are not
/// finite or outside the range of half precision; Cancelled.
KpcnWeights readKpcnWeights(const std::filesystem::path& path, const Progress& progress = {});

}  // namespace limpid::denoise
