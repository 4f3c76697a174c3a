// Displays linear radiance on a screen: exposure, filmic curve, sRGB. CPU version; the metrics use no curve.
#pragma once

#include <optional>
#include <span>

#include "image/filmic.h"
#include "image/image.h"
#include "image/tone_curve.h"

namespace limpid::image {

/// The inverse: the exposed radiance that filmicCurve maps to `display`, which lies in [0,1).
double filmicCurveInverse(double display);

/// Returns the exposure in stops that maps the picture's average luminance to 0.18: log2(0.18 / average). The
/// average is geometric (Reinhard et al., "Photographic Tone Reproduction for Digital Images", 2002), over
/// finite pixels brighter than 1e-5 of the arithmetic mean: black backgrounds have no logarithm and should
/// not affect exposure. Returns 0 if there is no such pixel; the result is within [-40, 40]. `radiance`:
/// linear, 3 or more components (1: grey).
///
/// `subject`, if not empty, has a number for each pixel. Only pixels with at least 0.5 count, unless there
/// are none, so that a bright sky does not darken the objects in front of it.
float autoExposure(const Image& radiance, std::span<const float> subject = {});

/// Like autoExposure(), but none if there is no pixel to measure.
std::optional<float> measuredExposure(const Image& radiance, std::span<const float> subject = {});

/// One exposure for a sequence, from measuredExposure of each frame: the mean of the available values, which
/// maps the geometric mean of the frames' averages to 0.18; 0 if there are none. Black frames do not count.
float sequenceExposure(std::span<const std::optional<float>> frames);

/// Returns encoded sRGB in [0,1] for a PNG: displayColor(curve, radiance * 2^stops) of the first 3
/// components; a fourth is alpha and is only clamped. `radiance`: linear, 1, 3 or 4 components; the result
/// has the same number. Of a colour that a curve gives to grey pictures of 1 component, red is taken.
Image tonemap(const Image& radiance, float stops, ToneCurve curve = ToneCurve::Standard);

}  // namespace limpid::image
