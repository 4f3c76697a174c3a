// Errors as colours.
#pragma once

#include <array>
#include <filesystem>

#include "image/image.h"

namespace limpid::image {

/// matplotlib's "magma" (Nathaniel Smith and Stefan van der Walt, CC0) at `value` in [0,1] (clamped; NaN is
/// 1): sRGB-encoded components in [0,1]. From black through purple and orange to pale yellow, which is the
/// map that FLIP is shown with. A polynomial fit of degree 6 (Matt Zucker,
/// https://www.shadertoy.com/view/WlfXRN, CC0), within 0.02 of the table.
std::array<float, 3> magma(float value);

/// Every value of a one-component image through magma: encoded, 3 components.
Image magma(const Image& values);

/// Writes errors in [0,1] (a FLIP map) as a PNG through magma, atomically. Throws OutputError.
void writeErrorMap(const std::filesystem::path& path, const Image& errors);

}  // namespace limpid::image
