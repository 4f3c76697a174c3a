// Temporal anti-aliasing in double precision, written from the formulas of docs/denoising.md and from nothing
// else: the oracle of the pass `taa`. Nothing is rounded.
#pragma once

#include <vector>

#include "tests/oracle/double_frame.h"

namespace limpid::test {

/// What the last frame left: mean as it was stored, number of frames. Of another size than the frame (none at
/// all before the first frame): nothing.
struct TaaPast {
    uint32_t width = 0, height = 0;
    std::vector<dvec4> mean;
};

struct TaaPixel {
    dvec3 mean{0.0};
    double frames = 0.0;
    /// A decision was so close that float32 may take the other one: compare nothing here.
    bool doubtful = false;
    /// By how much the mean changes if the position s is off, per pixel.
    dvec3 slope{0.0};
    /// What the rounding of float32 may make of the mean besides: bright light is a difference next to 0.
    dvec3 rounding{0.0};
};

/// E and its inverse.
dvec3 taaEncode(const dvec3& color);
dvec3 taaDecode(const dvec3& encoded);

/// One frame. `beauty`: four floats a pixel.
std::vector<TaaPixel> taa(const denoise::HostFrame& frame, const std::vector<float>& beauty,
                          const TaaPast& past, double frames);

}  // namespace limpid::test
