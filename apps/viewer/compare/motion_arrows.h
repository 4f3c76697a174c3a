// Motion as arrows over the picture.
#pragma once

#include <array>
#include <vector>

#include "base/math.h"
#include "image/image.h"

namespace limpid::viewer {

struct Arrow {
    vec2 from, to;  ///< pixels of the window
};

/// One for every square of 32 pixels of the window in whose middle something has moved by more than a quarter
/// of a pixel: from where it was in the frame before to where it is. `motion` as for studio::motionAt().
std::vector<Arrow> motionArrows(const image::Image& motion, float windowWidth, float windowHeight);

/// The corners of an arrow's head, the tip first, which is at Arrow::to.
std::array<vec2, 3> arrowHead(const Arrow& arrow);

}  // namespace limpid::viewer
