// The filmic curve used for PNG output and HDR-FLIP.
#pragma once

namespace limpid::image {

#include "image/tonemap_curve.h"

/// Maps exposed linear radiance to a linear display value in [0,1]; monotone. NaN and negative values give 0.
/// See image/tonemap_curve.h. Always inlined, since files that are compiled for one kind of processor use it.
[[gnu::always_inline]] inline float filmicCurve(float radiance) {
    const float positive = radiance > 0.0f ? radiance : 0.0f;
    const float x = filmicScale * (positive < filmicLargest ? positive : filmicLargest);
    const float y = x * (filmicA * x + filmicB) / (x * (filmicC * x + filmicD) + filmicE);
    return y < 1.0f ? y : 1.0f;
}

}  // namespace limpid::image
