// The layers of a network behind SVGF (`nano`, `film`), and their weights, which are part of the library.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
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

/// What tells networks apart, by level.
struct NanoShape {
    std::array<uint32_t, NANO_LEVELS> widths;  ///< channels, in groups
    std::array<uint32_t, NANO_LEVELS> depths;  ///< layers of 3x3 taps on the way down
};

/// The number of the logit that weighs a pixel in the next coarser level, the last of a signal's.
constexpr uint32_t nanoPoolLogit(size_t level) {
    const bool finest = level == 0;
    const int edge = 2 * (finest ? NANO_FINEST_REACH : NANO_REACH) + 1, shares = finest ? 2 : 0;
    return static_cast<uint32_t>(edge * edge + NANO_COARSER_TAPS + shares);
}

/// A workgroup's share of a layer on cooperative matrices, with the names of nano_matrix.glsl. Several
/// workgroups share the outputs of a pixel if `tiles` is less than their number. All need at most 48 KB of
/// shared memory.
struct NanoShare {
    uint32_t tiles = 0, rows = 0, loops = 1;
    bool small = false;  ///< a workgroup has fewer subgroups
};

/// By level; the coarsest level has no `point`, the finest no `halve`.
struct NanoShares {
    std::array<NanoShare, NANO_LEVELS> around, point, halve;
};

struct NanoNetwork {
    std::string name;  ///< its passes' names begin with it
    std::array<NanoLevel, NANO_LEVELS> levels;
    NanoShares shares;
    std::vector<std::byte> weights;   ///< texels of eight halves; rows of NANO_WEIGHTS_WIDTH, filled with 0
    std::vector<float> finestLogits;  ///< those of the last layer at the finest level, for NanoFinestParams
};

/// `file`: of weights, as training/limpid_training/nano/weights.py writes them. Throws Error if it does not
/// fit the shape.
NanoNetwork makeNanoNetwork(const std::string& name, const NanoShape& shape, const NanoShares& shares,
                            std::span<const uint32_t> file);

const NanoNetwork& nanoNetwork();

}  // namespace limpid::denoise
