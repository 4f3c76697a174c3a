#include "image/frame_scores.h"

namespace limpid::image {

const std::array<Metric, 7>& sequenceMetrics() {
    using Value = std::optional<double>;
    static const std::array<Metric, 7> metrics = {{
        {"psnr", true, [](const FrameScores& s) -> Value { return s.psnr; }},
        {"ssim", true, [](const FrameScores& s) -> Value { return s.ssim; }},
        {"relmse", false, [](const FrameScores& s) -> Value { return s.relMse; }},
        {"flip", false, [](const FrameScores& s) -> Value { return s.flip; }},
        {"hdr_flip", false, [](const FrameScores& s) -> Value { return s.hdrFlip; }},
        {"flicker", false, [](const FrameScores& s) -> Value { return s.flicker; }},
        {"temporal_error", false, [](const FrameScores& s) -> Value { return s.temporalError; }},
    }};
    return metrics;
}

std::optional<double> meanOf(const Metric& metric, std::span<const FrameScores> frames) {
    double sum = 0.0;
    size_t count = 0;
    for (const FrameScores& frame : frames) {
        const std::optional<double> value = metric.of(frame);
        sum += value.value_or(0.0);
        count += value ? 1 : 0;
    }
    if (count == 0) return std::nullopt;
    return sum / static_cast<double>(count);
}

std::optional<Worst> worstOf(const Metric& metric, std::span<const FrameScores> frames) {
    std::optional<Worst> worst;
    for (const FrameScores& frame : frames) {
        const std::optional<double> value = metric.of(frame);
        if (!value) continue;
        if (!worst || (metric.higherIsBetter ? *value < worst->value : *value > worst->value))
            worst = Worst{*value, frame.frame};
    }
    return worst;
}

}  // namespace limpid::image
