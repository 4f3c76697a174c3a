#include "studio/compare/comparison.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <exception>

#include "image/metrics/metrics.h"

namespace limpid::studio {

std::vector<std::string> comparisonNames() {
    std::vector<std::string> names{"nothing"};
    for (const Integrator integrator : integrators()) names.emplace_back(nameOf(integrator));
    for (const denoise::Denoiser& denoiser : denoise::denoisers()) names.emplace_back(denoiser.name);
    names.emplace_back("reference");
    names.emplace_back("kept settings");
    return names;
}

bool ComparisonChoice::isReference() const {
    return with == static_cast<int>(integrators().size() + denoise::denoisers().size()) + 1;
}

bool ComparisonChoice::isKept() const {
    return with == static_cast<int>(integrators().size() + denoise::denoisers().size()) + 2;
}

void ComparisonChoice::keep(const RenderSettings& settings) {
    kept = settings;
    kept.networks = {};
    with = static_cast<int>(comparisonNames().size()) - 1;
}

RenderSettings comparisonSettings(const ComparisonChoice& choice, const RenderSettings& settings) {
    RenderSettings other = settings;
    if (!choice.isOn()) return other;
    if (choice.isKept()) {
        other = choice.kept;
        other.extent = settings.extent;
        other.seed = settings.seed;
        other.layers = settings.layers;
        return other;
    }
    if (!canBeDenoised(other.pipeline.integrator)) other.pipeline.integrator = Integrator::Path;
    if (choice.isReference()) {
        other.pipeline.denoiser = nullptr;
        ++other.seed;
        if (other.jitter == Jitter::Frame) other.jitter = Jitter::Pixel;
        return other;
    }
    const size_t index = static_cast<size_t>(choice.with) - 1;
    if (index < integrators().size())
        other.pipeline = {integrators()[index]};
    else
        other.pipeline.denoiser = &denoise::denoisers()[index - integrators().size()];
    if (other.pipeline.denoiser)
        other.pipeline.integrator = integratorFor(*other.pipeline.denoiser, other.pipeline.integrator);
    return other;
}

void LiveScores::compare(image::Image test, image::Image reference, float exposure) {
    if (busy()) return;
    discards_ = false;
    pending_ = std::async(
        std::launch::async, [test = std::move(test), reference = std::move(reference), exposure]() -> Scores {
            try {
                const image::Image shown = image::displayEncode(test, exposure),
                                   wanted = image::displayEncode(reference, exposure);
                const double flip = image::mean(image::flip(shown, wanted)),
                             psnr = image::psnr(shown, wanted);
                if (std::isinf(psnr)) return {"the pictures are identical", 0.0f};
                return {fmt::format("PSNR {:.2f} dB, FLIP {:.4f}", psnr, flip), static_cast<float>(flip)};
            } catch (const std::exception& fault) {
                return {fault.what(), {}};
            }
        });
}

bool LiveScores::finish() {
    if (!busy() || pending_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    const Scores result = pending_.get();
    if (discards_) return false;
    text_ = result.text;
    if (result.flip) errors_.add(*result.flip);
    return true;
}

void LiveScores::clear() {
    text_.clear();
    errors_ = {};
    discards_ = true;
}

}  // namespace limpid::studio
