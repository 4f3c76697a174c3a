// What an image of motion says of one place.
#pragma once

#include "base/math.h"
#include "image/image.h"

namespace limpid::studio {

/// Where the surface at `position` (0 to 1 in the picture, from its upper left corner) was in the frame
/// before: that place minus this one, in pixels of the image. 0 where it rests, less than a quarter of a
/// pixel included, and where it is not known. `motion` as docs/layers.md has it; with four components, the
/// last one is 0 where it is not valid. It has pixels.
vec2 motionAt(const image::Image& motion, const vec2& position);

}  // namespace limpid::studio
