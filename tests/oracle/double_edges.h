// Smoothing of surfaces' edges in double precision, written only from the formulas of docs/denoising.md: the
// oracle of the passes `edges/find` and `edges/smooth`. It goes along whole edges, where the passes look from
// each pixel. Nothing is rounded.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/oracle/double_frame.h"

namespace limpid::test {

/// `beauty`: four floats per pixel; `reach`: pixels. Returns the colour of each pixel.
std::vector<dvec3> smoothedEdges(const denoise::HostFrame& frame, const std::vector<float>& beauty,
                                 int64_t reach);

}  // namespace limpid::test
