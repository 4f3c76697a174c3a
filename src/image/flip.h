// LDR-FLIP where it meets HDR-FLIP. Private to src/image; image/metrics.h is the public face.
#pragma once

#include "image/image.h"

namespace limpid::image {

/// flip() of images that are not encoded: linear display values in [0,1]. Saves HDR-FLIP an encoding that
/// LDR-FLIP would undo at once.
Image flipOfLinear(const Image& test, const Image& reference, double pixelsPerDegree);

}  // namespace limpid::image
