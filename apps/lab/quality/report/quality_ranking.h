// Methods of `limpid bench quality` in the order of their error over all sequences.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lab/quality/quality_run.h"

namespace limpid::cli {

/// Means over sequences, each a mean over its frames; none where there is no such number.
struct MethodRank {
    std::string name;
    double flip = 0.0;
    double rank = 0.0;           ///< mean place by FLIP, from 1; equals share the mean of their places
    std::optional<double> gain;  ///< PSNR beyond that of the noisy frames, dB
    std::optional<double> flicker, denoisingMs, bytesPerPixel;
    std::vector<std::string> best;  ///< sequences in which no method has a lower FLIP
};

/// By mean FLIP, the lowest first; every sequence must have the same methods. Empty without sequences.
std::vector<MethodRank> rankMethods(const QualityRun& run);

/// The mean of a metric (image::sequenceMetrics) by name over a method's frames.
std::optional<double> meanOf(const MethodQuality& method, std::string_view metric);

/// denoisingBytesPerPixel; none for the noisy frames.
std::optional<double> bytesPerPixel(const MethodQuality& method);

/// The median over frames, of all denoising passes together; none for the noisy frames.
std::optional<double> denoisingMs(const MethodQuality& method);

}  // namespace limpid::cli
