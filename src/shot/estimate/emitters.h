// Finds lamps in a picture, for files that have no layer of emission.
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"

namespace limpid::shot {

/// 1 for each pixel that shows a lamp. A lamp's light reaches the camera without noise, so neighbouring
/// pixels of it have the same colour (to 1 %), far above the median of lit pixels (4 times); at its edge,
/// pixels belong to it that have at least a quarter of its brightness. Lamps that are textured, or smaller
/// than 2x2 pixels, are not found. `beauty`: 3 components, linear. `distance`: 0 where nothing is seen, such
/// as a bright sky, which is no lamp.
std::vector<uint8_t> findEmitters(const image::Image& beauty, const std::vector<float>& distance);

}  // namespace limpid::shot
