// Temporal accumulation in double precision, written only from the formulas of docs/denoising.md: the oracle
// of the denoiser `temporal`.
#pragma once

#include <vector>

#include "tests/oracle/double_frame.h"

namespace limpid::test {

struct DoubleTemporalParams {
    double normal = 0.95;     ///< minimum cosine between normals
    double depth = 0.02;      ///< relative to the distance; with `relative` off in world units
    bool relative = true;     ///< off: absolute differences of distances
    bool search = true;       ///< search the nine surrounding pixels if no bilinear tap counts
    double minAlbedo = 0.1;   ///< 0: light is resampled with its albedo
    uint32_t maxHistory = 0;  ///< 0: no limit
    bool greyRestart = false;
    double grey = 0.5;
    bool greyMisses = false;
    bool identity = true;
};

/// The history. Images of another size than the frame's (empty before the first frame) count as zeros: no hit
/// anywhere.
struct TemporalImages {
    uint32_t width = 0, height = 0;
    std::vector<dvec4> colour;       ///< mean, count
    std::vector<dvec4> normalDepth;  ///< N, Z
    std::vector<dvec4> albedoId;     ///< A, I
};

struct TemporalPixel {
    int failure = 0;  ///< 0: history was found; else the case of step 2, Disocclusion, in docs/denoising.md
    bool rejected = false;  ///< the sample has a NaN or an infinity
    /// A decision was so close that float32 may decide otherwise: skip the comparison here.
    bool doubtful = false;
    /// Bounds the change of the new mean and count if the reprojected position s is off by one pixel.
    /// Multiplied by float32's error of s, it bounds the error that a correct shader may have between noisy
    /// taps.
    dvec4 slope{0.0};
};

struct TemporalResult {
    TemporalImages images;
    std::vector<TemporalPixel> pixels;
};

/// Computes one frame. `previous` is the result of an earlier call, or was downloaded from a device; then
/// errors do not accumulate, and a doubtful pixel in one frame does not affect the next.
TemporalResult accumulateTemporally(const denoise::HostFrame& frame, const TemporalImages& previous,
                                    const DoubleTemporalParams& params);

}  // namespace limpid::test
