// The metrics of every frame of a sequence, their means and their worst. See docs/metrics.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "image/metrics/metrics.h"

namespace limpid::image {

/// Whose motion layer flicker followed from the frame before: None is no motion.
enum class MotionSource { None, Reference, Test };

struct FrameScores {
    int frame = 0;
    double psnr = 0.0, ssim = 0.0, relMse = 0.0, flip = 0.0;  ///< as in Comparison
    std::optional<double> hdrFlip;  ///< none unless both pictures are scene-referred
    std::optional<HdrFlipExposures> hdrExposures;
    std::optional<double> flicker;        ///< none in the first frame, or where no pixel has a place before
    std::optional<double> temporalError;  ///< likewise
    double flickerPixels = 0.0;           ///< share of the pixels that flicker was measured on
    std::optional<MotionSource> motion;   ///< none in the first frame
    uint64_t invalidPixels = 0;
};

/// Which value of a metric is best.
enum class Best { Highest, Lowest, NearestToZero };

/// One of the numbers above by name.
struct Metric {
    std::string_view name;  ///< as in JSON
    Best best;
    std::optional<double> (*of)(const FrameScores& scores);
};

/// psnr, ssim, relmse, flip, hdr_flip, flicker, temporal_error.
const std::array<Metric, 7>& sequenceMetrics();

/// Arithmetic mean over the frames that have the metric; none if no frame has it. One frame equal to its
/// reference (PSNR infinite) makes the mean PSNR infinite. Where zero is best the mean is of magnitudes:
/// frames that change too little do not make up for others that change too much.
std::optional<double> meanOf(const Metric& metric, std::span<const FrameScores> frames);

struct Worst {
    double value = 0.0;  ///< the farthest from the best, with its sign
    int frame = 0;       ///< the first that has the value
};
std::optional<Worst> worstOf(const Metric& metric, std::span<const FrameScores> frames);

}  // namespace limpid::image
