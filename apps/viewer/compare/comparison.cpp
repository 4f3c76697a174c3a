#include "viewer/compare/comparison.h"

#include <fmt/format.h>

#include <chrono>
#include <exception>

#include "image/metrics/metrics.h"

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

void LiveScores::compare(image::Image test, image::Image reference, float exposure) {
    if (busy()) return;
    discards_ = false;
    pending_ =
        std::async(std::launch::async,
                   [test = std::move(test), reference = std::move(reference), exposure]() -> std::string {
                       try {
                           const image::Image shown = image::displayEncode(test, exposure),
                                              wanted = image::displayEncode(reference, exposure);
                           return fmt::format("PSNR {:.2f} dB, FLIP {:.4f}", image::psnr(shown, wanted),
                                              image::mean(image::flip(shown, wanted)));
                       } catch (const std::exception& fault) {
                           return fault.what();
                       }
                   });
}

bool LiveScores::finish() {
    if (!busy() || pending_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    const std::string result = pending_.get();
    if (discards_) return false;
    text_ = result;
    return true;
}

void LiveScores::clear() {
    text_.clear();
    discards_ = true;
}

}  // namespace limpid::viewer
