// Walker's alias method: one table look-up draws from any discrete distribution.
// M. D. Vose, "A linear algorithm for generating random numbers with a given distribution", 1991.
#pragma once

#include <vector>

#include "scene/device/scene_data.h"

namespace limpid::scene {

struct AliasTable {
    std::vector<AliasEntry> entries;
    std::vector<float> probabilities;  ///< normalised; what the table draws
};

/// Weights are finite and not negative. All zero (or none): a uniform table.
AliasTable buildAliasTable(std::vector<double> weights);

}  // namespace limpid::scene
