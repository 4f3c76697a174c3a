// The view of linear radiance on a screen: exposure, filmic curve, sRGB. CPU version; metrics use no curve.
#pragma once

#include <optional>
#include <span>

#include "image/filmic.h"
#include "image/image.h"

namespace limpid::image {

/// The inverse: the exposed radiance that filmicCurve takes to `display`, which lies in [0,1).
double filmicCurveInverse(double display);

/// The exposure in stops that brings the picture's average luminance to 0.18: log2(0.18 / average). The
/// average is geometric (Reinhard et al., "Photographic Tone Reproduction for Digital Images", 2002), over
/// pixels that are finite and brighter than 1e-5 of the arithmetic mean: black backgrounds have no logarithm
/// and say nothing about exposure. 0 if there is no such pixel; within [-40, 40]. `radiance`: linear, 3 or
/// more components (1: grey).
///
/// `subject`, if it is not empty, has a number for each pixel; pixels of at least 0.5 are what counts, unless
/// there are none. So a bright sky does not darken what stands before it.
float autoExposure(const Image& radiance, std::span<const float> subject = {});

/// The same; none where autoExposure has no such pixel to go by.
std::optional<float> measuredExposure(const Image& radiance, std::span<const float> subject = {});

/// One exposure for a sequence, from measuredExposure of each frame: the mean of those that there are, so the
/// geometric mean of the frames' averages comes to 0.18; 0 if there are none. Black frames do not count.
float sequenceExposure(std::span<const std::optional<float>> frames);

/// Encoded sRGB in [0,1] for a PNG: filmicCurve(radiance * 2^stops), then sRGB, for the first 3 components; a
/// fourth is alpha and is only clamped. `radiance`: linear, 1, 3 or 4 components; the result has as many.
Image tonemap(const Image& radiance, float stops);

}  // namespace limpid::image
