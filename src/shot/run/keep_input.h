// What of the noisy picture stays in the result: --strength and --preserve.
#pragma once

#include <vector>

#include "image/image.h"

namespace limpid::shot {

/// Moves `clean` (RGBA per pixel) to `noisy` (3 components): strength 1 leaves it, 0 makes it the noisy
/// picture. Values that are not finite stay out.
void mix(std::vector<float>& clean, const image::Image& noisy, float strength);

/// Gives back what denoising changed in the mean over 5x5 pixels: `preserve` (0 to 1) is the share of it.
/// Noise averages out there, so what remains of the difference is mostly detail that was filtered away: faint
/// textures, contact shadows, small highlights. The weights are binomial (1, 4, 6, 4, 1), which let 7 % of
/// the variance of white noise through. Differences are limited to 4 times the mean around them, so that
/// single bright samples do not come back.
void restoreDetail(std::vector<float>& clean, const image::Image& noisy, float preserve);

}  // namespace limpid::shot
