// Flicker: how much more a sequence changes from frame to frame than its reference does. Definition:
// docs/metrics.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "image/image.h"
#include "image/metrics/geometry.h"

namespace limpid::image {

/// For each pixel of a frame, where its surface point was in the previous frame: the four pixels around that
/// position, and their bilinear weights.
struct Reprojection {
    struct Source {
        int32_t x = 0, y = 0;  ///< the upper left of the four pixels; may lie one pixel outside the picture
        std::array<float, 4> shares{};  ///< weights of (x,y), (x+1,y), (x,y+1), (x+1,y+1); the sum is 1, or 0
                                        ///< for an excluded pixel
    };
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<Source> sources;  ///< width * height
    size_t used = 0;              ///< pixels that are not excluded
};

/// Maps every pixel to itself: for sequences without a motion layer.
Reprojection stillReprojection(uint32_t width, uint32_t height);

/// Follows the motion layer of `now`. A pixel is excluded if
/// - its motion is invalid (validMotion) or leads out of the picture, or
/// - all of the four pixels with a bilinear weight above 0 show another surface: their depth differs by more
///   than 10 % from the expected depth + distanceChange, or their normal by more than 45 degrees. If only
///   some do, their weight is distributed over the others.
/// Depth and normal are tested only if both frames have them (and for depth, if `now` has distanceChange).
/// Throws Error if there is no motion, or if layers differ in size.
Reprojection reproject(const Geometry& now, const Geometry& before);

/// Returns the mean of |now - reprojected before| over the components of all pixels that are not excluded;
/// nothing if all are excluded. Throws Error unless the images have 3 components and all sizes are equal.
std::optional<double> temporalChange(const Image& now, const Image& before, const Reprojection& reprojection);

/// Returns temporalChange() of the test pictures minus that of the references, over the same pixels. Pictures
/// are display-encoded (displayEncode()), so the result is in [-1,1]. It is 0 if the test changes as much as
/// its reference, even if its colours are wrong, and negative if the test changes less, for example because
/// of too much temporal filtering.
std::optional<double> flicker(const Image& test, const Image& testBefore, const Image& reference,
                              const Image& referenceBefore, const Reprojection& reprojection);

/// Returns temporalChange() of the error, test minus reference. It measures every change that only one of the
/// two has: noise, but also lag. (In flicker(), which subtracts the two changes, noise and lag can cancel.)
/// Pictures are display-encoded. The result is in [0,2]: 0 if the error is constant over time.
std::optional<double> temporalError(const Image& test, const Image& testBefore, const Image& reference,
                                    const Image& referenceBefore, const Reprojection& reprojection);

}  // namespace limpid::image
