// Means over windows of pixels.
#pragma once

#include "image/image.h"

namespace limpid::shot {

/// The mean of each component over (2 `radius` + 1)^2 pixels, in time that does not depend on `radius`.
/// Beyond the borders, the pixels at the border count again.
image::Image boxMeans(const image::Image& picture, uint32_t radius);

}  // namespace limpid::shot
