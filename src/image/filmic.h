// The filmic curve used for PNG output and HDR-FLIP.
#pragma once

#include <algorithm>

namespace limpid::image {

#include "image/tonemap_curve.h"

/// Maps exposed linear radiance to a linear display value in [0,1]; monotone. NaN and negative values give 0.
/// See image/tonemap_curve.h.
inline float filmicCurve(float radiance) {
    const float positive = radiance > 0.0f ? radiance : 0.0f;
    const float x = filmicScale * std::min(positive, filmicLargest);
    const float y = x * (filmicA * x + filmicB) / (x * (filmicC * x + filmicD) + filmicE);
    return std::min(y, 1.0f);
}

}  // namespace limpid::image
