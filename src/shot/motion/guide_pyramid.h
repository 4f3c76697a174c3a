// What frames are matched by: layers that are nearly free of noise, at several resolutions.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "shot/frame/shot_frame.h"

namespace limpid::shot {

/// Albedo, normal and depth of a pixel, in eight bytes: three, three, one and an unused one. So a row of a
/// block can be compared with few instructions. Differences of an albedo's square root count twice as much as
/// those of a normal; an octave of depth counts ten steps, since depth changes with a camera's movement.
using GuideTexel = std::array<uint8_t, 8>;

struct GuideLevel {
    int width = 0, height = 0;
    std::vector<GuideTexel> texels;

    const GuideTexel& at(int x, int y) const {
        return texels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
    }
    /// The nearest pixel of the picture.
    const GuideTexel& clamped(int x, int y) const;
};

/// From the finest level, which is slightly smoothed so that positions between pixels are comparable, to the
/// coarsest, whose smaller side has 12 to 24 pixels; each has half the resolution of the one before. Empty
/// if there is neither an albedo nor a normal.
std::vector<GuideLevel> guidePyramid(const ShotLayers& layers);

/// The sum of the differences of the components.
inline int differenceOf(const GuideTexel& a, const GuideTexel& b) {
    int sum = 0;
    for (size_t c = 0; c < a.size(); ++c) sum += a[c] > b[c] ? a[c] - b[c] : b[c] - a[c];
    return sum;
}

}  // namespace limpid::shot
