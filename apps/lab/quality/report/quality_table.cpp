#include "lab/quality/report/quality_table.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "image/metrics/frame_scores.h"
#include "lab/quality/report/quality_ranking.h"

namespace limpid::cli {
namespace {

/// Formats a number of a line; it may be absent or infinite.
std::string cell(std::optional<double> value, int width, int digits) {
    return value ? fmt::format("{:>{}.{}f}", *value, width, digits) : fmt::format("{:>{}}", "-", width);
}

/// Equal pictures have an infinite PSNR; the gain between two of them is undefined.
std::string gainText(double gain) {
    return std::isnan(gain) ? "-" : fmt::format("{:+.2f}", gain);
}

}  // namespace

void printHead(const QualityRun& run) {
    fmt::print(
        "{}, {}x{}, {} samples a frame\n  {:<28}{:>9}{:>8}{:>9}{:>9}{:>10}{:>9}{:>10}"
        "{:>10}{:>10}{:>9}\n",
        run.device, run.extent.width, run.extent.height, run.samples, "method", "PSNR dB", "gain", "worst",
        "SSIM", "relMSE", "FLIP", "flicker", "temporal", "filter ms", "B/pixel");
}

void printSequence(const MeasuredSequence& measured) {
    const SequenceQuality& quality = measured.quality;
    fmt::print("{} (reference: {} samples, {:.1f} dB by itself)\n", measured.sequence.name,
               measured.sequence.referenceSamples, quality.referencePsnr);
    const double noisyPsnr = meanOf(quality.methods.front(), "psnr").value_or(0.0);
    for (const MethodQuality& method : quality.methods) {
        const double psnr = meanOf(method, "psnr").value_or(0.0);
        fmt::print("  {:<28}{:>9.2f}{:>8}{:>9.2f}{}{}{}{}{}{}{}\n", method.name, psnr,
                   gainText(psnr - noisyPsnr),
                   image::worstOf(image::sequenceMetrics()[0], method.scores)->value,
                   cell(meanOf(method, "ssim"), 9, 4), cell(meanOf(method, "relmse"), 10, 5),
                   cell(meanOf(method, "flip"), 9, 4), cell(meanOf(method, "flicker"), 10, 5),
                   cell(meanOf(method, "temporal_error"), 10, 5), cell(denoisingMs(method), 10, 3),
                   cell(bytesPerPixel(method), 9, 0));
    }
    std::fflush(stdout);  // a run may take long, and may be stopped
}

void printRanking(const QualityRun& run) {
    fmt::print("all {} sequences\n  {:<28}{:>9}{:>8}{:>9}{:>10}{:>10}{:>9}  best in\n", run.sequences.size(),
               "method", "FLIP", "rank", "gain dB", "flicker", "filter ms", "B/pixel");
    for (const MethodRank& rank : rankMethods(run)) {
        std::string best;
        for (const std::string& name : rank.best) best += (best.empty() ? "" : ", ") + name;
        fmt::print("  {:<28}{:>9.4f}{:>8.2f}{}{}{}{}  {}\n", rank.name, rank.flip, rank.rank,
                   cell(rank.gain, 9, 2), cell(rank.flicker, 10, 5), cell(rank.denoisingMs, 10, 3),
                   cell(rank.bytesPerPixel, 9, 0), best);
    }
}

}  // namespace limpid::cli
