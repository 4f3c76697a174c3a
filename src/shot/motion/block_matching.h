// Motion between two frames by hierarchical block matching: from coarse to fine, each block starts with what
// the level above found around it.
//
// The scheme is that of G. de Haan et al., "True-Motion Estimation with 3-D Recursive Search Block Matching",
// IEEE Trans. Circuits and Systems for Video Technology 3(5), 1993 (candidates from neighbours, a penalty on
// what differs from them), on a pyramid instead of recursively, so that all blocks of a level are
// independent.
#pragma once

#include <cstdint>
#include <vector>

#include "base/math.h"
#include "shot/motion/guide_pyramid.h"

namespace limpid::shot {

/// Blocks have 8x8 pixels, and their centres have this distance.
inline constexpr int blockDistance = 4;

/// The motion of each block: where it was in the other frame minus where it is, in pixels; x right, y down.
struct MotionField {
    int columns = 0, rows = 0;
    std::vector<vec2> motion;

    /// Block (0, 0) has its centre between the pixels 1 and 2; indices outside give the nearest block.
    const vec2& at(int column, int row) const;
};

/// Both pyramids have levels of the same sizes, at least one. Multi-threaded; the result does not depend on
/// the number of threads. Blocks without texture have the motion of blocks around them that have some.
MotionField matchBlocks(const std::vector<GuideLevel>& now, const std::vector<GuideLevel>& before);

}  // namespace limpid::shot
