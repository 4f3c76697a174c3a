// Finds lamps in a picture, for files that have no layer of emission.
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"

namespace limpid::shot {

/// Layers without noise that tell surfaces apart; null if they are missing.
struct SurfaceGuides {
    const image::Image *albedo = nullptr, *normal = nullptr, *id = nullptr;
};

/// 1 for each pixel that shows a lamp. A lamp's light reaches the camera without noise, so neighbouring
/// pixels of it have the same colour (to 1 %), far above the median of lit pixels (4 times); at its edge,
/// pixels belong to it that have at least a quarter of its brightness. Lamps that are textured, or smaller
/// than 2x2 pixels, are not found. `beauty`: 3 components, linear. `distance`: 0 where nothing is seen, such
/// as a bright sky, which is no lamp.
///
/// Infinite pixels are alike, too. Where a renderer spreads samples by its pixel filter, one of infinite
/// light makes a spot of up to 4x4 of them, which lies on a surface as noise does. So a spot of this size is
/// a lamp only if it is a surface of its own: if it has an id that none of the pixels around it has. Without
/// ids (or if all are the same, as where nobody gave any) it must have such an albedo or normal, and at least
/// half of the pixels around must be alike: in fine detail, such as leaves, every pixel differs from others.
std::vector<uint8_t> findEmitters(const image::Image& beauty, const std::vector<float>& distance,
                                  const SurfaceGuides& guides = {});

}  // namespace limpid::shot
