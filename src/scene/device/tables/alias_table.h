// Walker's alias method: samples any discrete distribution with one table look-up.
// M. D. Vose, "A linear algorithm for generating random numbers with a given distribution", 1991.
#pragma once

#include <vector>

#include "scene/device/scene_data.h"

namespace limpid::scene {

struct AliasTable {
    std::vector<AliasEntry> entries;
    std::vector<float> probabilities;  ///< normalised probabilities of the entries
};

/// Weights must be finite and not negative. If all are zero, or there are none, the table is uniform.
AliasTable buildAliasTable(std::vector<double> weights);

}  // namespace limpid::scene
