#include "lab/quality/report/quality_ranking.h"

#include <algorithm>
#include <cmath>

#include "cli/console/pass_times.h"

namespace limpid::cli {
namespace {

/// The mean of the finite values.
class Mean {
  public:
    void add(std::optional<double> value) {
        if (!value || !std::isfinite(*value)) return;
        sum_ += *value;
        ++count_;
    }
    std::optional<double> value() const {
        return count_ > 0 ? std::optional(sum_ / static_cast<double>(count_)) : std::nullopt;
    }

  private:
    double sum_ = 0.0;
    size_t count_ = 0;
};

double flipOf(const MethodQuality& method) {
    return meanOf(method, "flip").value_or(1.0);
}

/// Returns the mean of the positions that methods with this error share.
double placeOf(const MethodQuality& method, const std::vector<MethodQuality>& all) {
    const double flip = flipOf(method);
    const auto better = std::ranges::count_if(all, [&](const MethodQuality& m) { return flipOf(m) < flip; });
    const auto equal = std::ranges::count_if(all, [&](const MethodQuality& m) { return flipOf(m) == flip; });
    return static_cast<double>(better) + 0.5 * static_cast<double>(equal + 1);
}

MethodRank rankOf(const QualityRun& run, size_t index) {
    MethodRank rank;
    rank.name = run.sequences.front().quality.methods[index].name;
    Mean flip, place, gain, flicker, ms, bytes;
    for (const MeasuredSequence& measured : run.sequences) {
        const std::vector<MethodQuality>& methods = measured.quality.methods;
        const MethodQuality& method = methods[index];
        flip.add(flipOf(method));
        place.add(placeOf(method, methods));
        const auto psnr = meanOf(method, "psnr"), noisy = meanOf(methods.front(), "psnr");
        if (psnr && noisy) gain.add(*psnr - *noisy);
        flicker.add(meanOf(method, "flicker"));
        ms.add(denoisingMs(method));
        bytes.add(bytesPerPixel(method));
        const bool best =
            std::ranges::none_of(methods, [&](const auto& m) { return flipOf(m) < flipOf(method); });
        if (best) rank.best.push_back(measured.sequence.name);
    }
    rank.flip = flip.value().value_or(1.0);
    rank.rank = place.value().value_or(0.0);
    rank.gain = gain.value();
    rank.flicker = flicker.value();
    rank.denoisingMs = ms.value();
    rank.bytesPerPixel = bytes.value();
    return rank;
}

}  // namespace

std::optional<double> meanOf(const MethodQuality& method, std::string_view metric) {
    const auto& metrics = image::sequenceMetrics();
    const auto found = std::ranges::find(metrics, metric, &image::Metric::name);
    return found == metrics.end() ? std::nullopt : image::meanOf(*found, method.scores);
}

std::optional<double> denoisingMs(const MethodQuality& method) {
    return method.denoisingMs.empty() ? std::nullopt : std::optional(median(method.denoisingMs));
}

std::optional<double> bytesPerPixel(const MethodQuality& method) {
    return method.denoisingBytesPerPixel > 0.0 ? std::optional(method.denoisingBytesPerPixel) : std::nullopt;
}

std::vector<MethodRank> rankMethods(const QualityRun& run) {
    std::vector<MethodRank> ranks;
    if (run.sequences.empty()) return ranks;
    for (size_t i = 0; i < run.sequences.front().quality.methods.size(); ++i) ranks.push_back(rankOf(run, i));
    std::ranges::stable_sort(ranks, {}, &MethodRank::flip);
    return ranks;
}

}  // namespace limpid::cli
