// Chooses texels of a picture, or entries of a list, in proportion to weights so that points which are spread
// evenly over the unit square or interval stay so: hierarchical sample warping, P. Clarberg, W. Jarosz, T.
// Akenine-Moeller, H. W. Jensen, "Wavelet Importance Sampling: Efficiently Evaluating Products of Complex
// Functions", SIGGRAPH 2005, section 4. (An alias table needs one look-up only, but tears the points apart.)
#pragma once

#include <cstdint>
#include <vector>

#include "base/math.h"

namespace limpid::scene {

/// Weights are combined by fours, level by level, until one record has them all. The coarsest level comes
/// first. A record has the probabilities of its four parts; parts beyond the end have 0. A single weight has
/// no records.
/// - Of a picture, level k has ceil(width / 2^k) times ceil(height / 2^k) records in rows, each for a square
/// of
///   2^k texels. Its parts are the square's quarters (x, y) = (0, 0), (1, 0), (0, 1), (1, 1).
/// - Of a list, level k has ceil(count / 4^k) records, each for 4^k successive entries.
struct WeightPyramid {
    std::vector<vec4> records;
    std::vector<float> probabilities;  ///< of texels or entries; their sum is 1
};

/// Weights must be finite and not negative. If all are zero, each is as probable as any other. Those of a
/// picture are in rows.
WeightPyramid buildWeightPyramid(std::vector<double> weights, uint32_t width, uint32_t height);
WeightPyramid buildWeightPyramid(std::vector<double> weights);

}  // namespace limpid::scene
