// The metrics of every frame of a sequence, their means and worst values. See docs/metrics.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "image/metrics/metrics.h"

namespace limpid::image {

/// Which picture's motion layer was used to reproject the previous frame for flicker; None: no motion layer.
enum class MotionSource { None, Reference, Test };

struct FrameScores {
    int frame = 0;
    double psnr = 0.0, ssim = 0.0, relMse = 0.0, flip = 0.0;  ///< as in Comparison
    std::optional<double> hdrFlip;  ///< none unless both pictures are scene-referred
    std::optional<HdrFlipExposures> hdrExposures;
    std::optional<double> flicker;        ///< none in the first frame, or if all pixels are excluded
    std::optional<double> temporalError;  ///< likewise
    double flickerPixels = 0.0;           ///< fraction of the pixels that flicker was measured on
    std::optional<MotionSource> motion;   ///< none in the first frame
    uint64_t invalidPixels = 0;
};

/// Which value of a metric is best.
enum class Best { Highest, Lowest, NearestToZero };

/// Access to one of the numbers in FrameScores by name.
struct Metric {
    std::string_view name;  ///< as in JSON
    Best best;
    std::optional<double> (*of)(const FrameScores& scores);
};

/// Returns psnr, ssim, relmse, flip, hdr_flip, flicker and temporal_error.
const std::array<Metric, 7>& sequenceMetrics();

/// Returns the arithmetic mean over the frames that have the metric; nothing if no frame has it. A single
/// frame that equals its reference (infinite PSNR) makes the mean PSNR infinite. For metrics of which zero is
/// best, it is the mean of absolute values, so that frames that change too little do not cancel frames that
/// change too much.
std::optional<double> meanOf(const Metric& metric, std::span<const FrameScores> frames);

struct Worst {
    double value = 0.0;  ///< the value farthest from the best, with its sign
    int frame = 0;       ///< the first frame with this value
};
std::optional<Worst> worstOf(const Metric& metric, std::span<const FrameScores> frames);

}  // namespace limpid::image
