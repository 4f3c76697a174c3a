#include "image/metrics/frame_scores.h"

#include <cmath>

namespace limpid::image {
namespace {

/// The higher the worse.
double badness(const Metric& metric, double value) {
    switch (metric.best) {
        case Best::Highest:
            return -value;
        case Best::Lowest:
            return value;
        case Best::NearestToZero:
            return std::abs(value);
    }
    return value;
}

}  // namespace

const std::array<Metric, 7>& sequenceMetrics() {
    using Value = std::optional<double>;
    static const std::array<Metric, 7> metrics = {{
        {"psnr", Best::Highest, [](const FrameScores& s) -> Value { return s.psnr; }},
        {"ssim", Best::Highest, [](const FrameScores& s) -> Value { return s.ssim; }},
        {"relmse", Best::Lowest, [](const FrameScores& s) -> Value { return s.relMse; }},
        {"flip", Best::Lowest, [](const FrameScores& s) -> Value { return s.flip; }},
        {"hdr_flip", Best::Lowest, [](const FrameScores& s) -> Value { return s.hdrFlip; }},
        {"flicker", Best::NearestToZero, [](const FrameScores& s) -> Value { return s.flicker; }},
        {"temporal_error", Best::Lowest, [](const FrameScores& s) -> Value { return s.temporalError; }},
    }};
    return metrics;
}

std::optional<double> meanOf(const Metric& metric, std::span<const FrameScores> frames) {
    double sum = 0.0;
    size_t count = 0;
    for (const FrameScores& frame : frames) {
        const std::optional<double> value = metric.of(frame);
        if (!value) continue;
        sum += metric.best == Best::NearestToZero ? std::abs(*value) : *value;
        ++count;
    }
    if (count == 0) return std::nullopt;
    return sum / static_cast<double>(count);
}

std::optional<Worst> worstOf(const Metric& metric, std::span<const FrameScores> frames) {
    std::optional<Worst> worst;
    for (const FrameScores& frame : frames) {
        const std::optional<double> value = metric.of(frame);
        if (!value) continue;
        if (!worst || badness(metric, *value) > badness(metric, worst->value))
            worst = Worst{*value, frame.frame};
    }
    return worst;
}

}  // namespace limpid::image
