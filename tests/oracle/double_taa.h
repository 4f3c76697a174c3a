// Temporal anti-aliasing in double precision, written only from the formulas of docs/denoising.md: the oracle
// of the pass `taa`. Nothing is rounded.
#pragma once

#include <vector>

#include "tests/oracle/double_frame.h"

namespace limpid::test {

/// The history: the mean as stored, and the number of frames. Ignored if it has another size than the frame
/// (empty before the first frame).
struct TaaPast {
    uint32_t width = 0, height = 0;
    std::vector<dvec4> mean;
};

struct TaaPixel {
    dvec3 mean{0.0};
    double frames = 0.0;
    /// A decision was so close that float32 may decide otherwise: skip the comparison here.
    bool doubtful = false;
    /// The change of the mean if the position s is off, per pixel.
    dvec3 slope{0.0};
    /// Bounds further rounding errors of the mean in float32: bright light is encoded as a small difference
    /// from a limit, which rounds coarsely.
    dvec3 rounding{0.0};
};

/// How many frames are averaged at most where something moves, and where nothing does.
struct TaaFrames {
    double moving, still;
};

/// E, the colour transform of docs/denoising.md, "Temporal anti-aliasing", and its inverse.
dvec3 taaEncode(const dvec3& color);
dvec3 taaDecode(const dvec3& encoded);

/// Computes one frame. `beauty`: four floats per pixel. `jitter`: from the pixels' centres to the frame's
/// rays.
std::vector<TaaPixel> taa(const denoise::HostFrame& frame, const std::vector<float>& beauty,
                          const TaaPast& past, const TaaFrames& frames, const dvec2& jitter = dvec2(0.0));

}  // namespace limpid::test
