// The layers of `nano`, and their weights, which are part of the library.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "denoise/methods/nano/nano_params.h"

namespace limpid::denoise {

/// A layer's size in groups of eight channels, and the index of its first texel of weights: its biases, then
/// for each tap, each group of inputs (those of the coarser level come last), and each group of outputs eight
/// texels, one for each input with the weights of its eight outputs.
struct NanoLayer {
    uint32_t inputs = 0, coarser = 0, outputs = 0;
    uint32_t weights = 0;
};

/// Level 0 is the finest.
struct NanoLevel {
    NanoLayer halve;                ///< from the finer level; at level 0 from the features
    std::vector<NanoLayer> around;  ///< on the way down
    NanoLayer join;                 ///< with the coarser level; none at the coarsest
    NanoLayer after;                ///< likewise
    NanoLayer logits;               ///< outputs: of both signals
};

struct NanoNetwork {
    std::array<NanoLevel, NANO_LEVELS> levels;
    std::span<const std::byte> weights;  ///< texels of eight halves
};

const NanoNetwork& nanoNetwork();

}  // namespace limpid::denoise
