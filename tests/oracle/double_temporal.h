// Temporal accumulation in double precision, written from the formulas of docs/denoising.md and from nothing
// else: the oracle of the denoiser `temporal`.
#pragma once

#include <vector>

#include "tests/oracle/double_frame.h"

namespace limpid::test {

struct DoubleTemporalParams {
    double normal = 0.95;     ///< least cosine between normals
    double depth = 0.02;      ///< of the distance; with `relative` off in world units
    bool relative = true;     ///< off: plain differences of distances
    bool search = true;       ///< among the nine pixels around where no bilinear tap counts
    bool demodulate = true;   ///< light is resampled, textures are not
    uint32_t maxHistory = 0;  ///< 0: no limit
    bool greyRestart = false;
    double grey = 0.5;
    bool greyMisses = false;
    bool identity = true;
};

/// What lives from frame to frame. Images of another size than the frame's (none at all before the first
/// frame) mean the same as zeros: nothing was seen.
struct TemporalImages {
    uint32_t width = 0, height = 0;
    std::vector<dvec4> colour;       ///< mean, count
    std::vector<dvec4> normalDepth;  ///< N, Z
    std::vector<dvec4> albedoId;     ///< A, I
};

struct TemporalPixel {
    int failure = 0;        ///< 0: history was found; else the failure case of the specification
    bool rejected = false;  ///< the sample has a NaN or an infinity
    /// A decision was so close that float32 may take the other one: compare nothing here.
    bool doubtful = false;
    /// By how much the new mean and count change at most if the back-projected position s is off by one
    /// pixel: times float32's error of s, this is how far a right shader may be off between noisy taps.
    dvec4 slope{0.0};
};

struct TemporalResult {
    TemporalImages images;
    std::vector<TemporalPixel> pixels;
};

/// One frame. `previous` is what an earlier call returned, or what was downloaded from a device: then errors
/// do not build up, and a doubtful pixel of one frame spoils nothing in the next.
TemporalResult accumulateTemporally(const denoise::HostFrame& frame, const TemporalImages& previous,
                                    const DoubleTemporalParams& params);

}  // namespace limpid::test
