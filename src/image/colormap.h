// Maps errors to colours.
#pragma once

#include <array>
#include <filesystem>

#include "image/image.h"

namespace limpid::image {

/// Returns the colour of matplotlib's "magma" (Nathaniel Smith and Stefan van der Walt, CC0) at `value` in
/// [0,1] (clamped; NaN counts as 1): sRGB-encoded components in [0,1], from black through purple and orange
/// to pale yellow. FLIP maps use this colour map. A polynomial fit of degree 6 (Matt Zucker,
/// https://www.shadertoy.com/view/WlfXRN, CC0), within 0.02 of the table.
std::array<float, 3> magma(float value);

/// Maps every value of a one-component image: encoded, 3 components.
Image magma(const Image& values);

/// Writes errors in [0,1] (a FLIP map) as a PNG with magma colours, atomically. Throws OutputError.
void writeErrorMap(const std::filesystem::path& path, const Image& errors);

}  // namespace limpid::image
