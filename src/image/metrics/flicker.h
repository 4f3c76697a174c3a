// Flicker: how much more a sequence changes from frame to frame than its reference does. docs/metrics.md has
// the definition in words.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "image/image.h"
#include "image/metrics/geometry.h"

namespace limpid::image {

/// For each pixel of a frame, where to find what it shows in the frame before: the four pixels around that
/// place, and their shares.
struct Reprojection {
    struct Source {
        int32_t x = 0, y = 0;           ///< the upper left of the four; may lie one outside the picture
        std::array<float, 4> shares{};  ///< of (x,y), (x+1,y), (x,y+1), (x+1,y+1): sum 1, or 0: excluded
    };
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<Source> sources;  ///< width * height
    size_t used = 0;              ///< pixels that are not excluded
};

/// Every pixel shows what it showed: for sequences without motion, of which nothing is known to move.
Reprojection stillReprojection(uint32_t width, uint32_t height);

/// By the motion of `now`, which must be there. A pixel is excluded where
/// - its motion is no valid one (validMotion), or leads out of the picture, or
/// - all of the four pixels there, as far as they count (bilinear share), show another surface: their depth
/// is
///   more than 10 % away from the expected depth + distanceChange, or their normal more than 45 degrees away.
///   Where only some do, the others share what those had.
/// Depth and normal are tested only if both frames have them (and `now` has distanceChange, for depth).
/// Throws Error if there is no motion, or if layers differ in size.
Reprojection reproject(const Geometry& now, const Geometry& before);

/// Mean of |now - before as reprojected| over components of pixels not excluded; none if all are. All three
/// of one size, the images of 3 components; throws Error if not.
std::optional<double> temporalChange(const Image& now, const Image& before, const Reprojection& reprojection);

/// temporalChange of the test pictures minus that of the references, over the same pixels. All pictures as
/// shown (displayEncode), so the result is in [-1,1]: 0 if the test changes as its reference does, however
/// wrong it is; negative if it changes less, as after too much filtering over time.
std::optional<double> flicker(const Image& test, const Image& testBefore, const Image& reference,
                              const Image& referenceBefore, const Reprojection& reprojection);

/// temporalChange of the error, test minus reference: what changes in one of them and not in the other, be it
/// noise or lag, which flicker() sets off against each other. Pictures as for flicker(); in [0,2], 0 if the
/// error stays as it is.
std::optional<double> temporalError(const Image& test, const Image& testBefore, const Image& reference,
                                    const Image& referenceBefore, const Reprojection& reprojection);

}  // namespace limpid::image
