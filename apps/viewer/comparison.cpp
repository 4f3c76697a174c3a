#include "comparison.h"

#include <fmt/format.h>

#include <chrono>

#include "base/error.h"
#include "image/metrics.h"

namespace limpid::viewer {

std::vector<std::string> comparisonNames() {
    std::vector<std::string> names{"nothing"};
    for (const Pipeline& pipeline : pipelines()) names.emplace_back(pipeline.name());
    names.emplace_back("reference");
    return names;
}

bool ComparisonChoice::isReference() const {
    return with == static_cast<int>(pipelines().size()) + 1;
}

RenderSettings comparisonSettings(const ComparisonChoice& choice, const RenderSettings& settings) {
    RenderSettings other = settings;
    if (choice.isReference()) {
        other.pipeline = {};
        ++other.seed;
        if (other.jitter == Jitter::Frame) other.jitter = Jitter::Pixel;
        return other;
    }
    other.pipeline = pipelines().at(static_cast<size_t>(choice.with) - 1);
    return other;
}

void LiveScores::compare(image::Image test, image::Image reference, float exposure,
                         std::function<void()> wake) {
    if (busy()) return;
    pending_ = std::async(std::launch::async, [test = std::move(test), reference = std::move(reference),
                                               exposure, wake = std::move(wake)] {
        std::string result;
        try {
            const image::Image shown = image::displayEncode(test, exposure),
                               wanted = image::displayEncode(reference, exposure);
            result = fmt::format("PSNR {:.2f} dB, FLIP {:.4f}", image::psnr(shown, wanted),
                                 image::mean(image::flip(shown, wanted)));
        } catch (const Error& fault) {
            result = fault.what();
        }
        wake();
        return result;
    });
}

const std::string& LiveScores::text() {
    if (busy() && pending_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
        text_ = pending_.get();
    return text_;
}

}  // namespace limpid::viewer
