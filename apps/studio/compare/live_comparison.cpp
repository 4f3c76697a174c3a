#include "studio/compare/live_comparison.h"

#include "base/text/format.h"

namespace limpid::studio {
namespace {

constexpr uint64_t numbersAlone = 1 << 24;  ///< far from the numbers of any frames of the picture
constexpr std::chrono::seconds betweenScores(1);

}  // namespace

RenderSettings settingsOfComparison(const State& state, const RenderSettings& main,
                                    const Networks& networks) {
    RenderSettings settings = comparisonSettings(state.comparison, main);
    if (state.jitter == 0 && !state.comparison.isReference())
        settings.jitter = defaultJitter(settings.pipeline);
    networks.set(settings);
    return settings;
}

void LiveComparison::drop() {
    other_.drop();
    scores_.clear();
    name_.clear();
}

bool LiveComparison::mustRender(const State& state, const RenderSettings& main, const CameraParams& camera,
                                bool moved) const {
    const gpu::Extent extent = main.extent;
    if (!state.comparison.isOn() || waits_ || extent.width == 0 || extent.height == 0) return false;
    const int wanted = state.comparison.isReference() ? state.comparison.referenceSamples : state.maxSamples;
    return moved || other_.differs(settingsOfComparison(state, main, networks_), state.samples) ||
           !sameCamera(camera, other_.camera()) || other_.samples() < static_cast<uint64_t>(wanted);
}

void LiveComparison::render(Stage& stage, const State& state, const RenderSettings& main, Moment moment,
                            bool alone) {
    const RenderSettings now = settingsOfComparison(state, main, networks_);
    if (other_.differs(now, state.samples)) other_.noteChange();
    const std::string choice = comparisonNames()[static_cast<size_t>(state.comparison.with)];
    if (std::exchange(choice_, choice) != choice) scores_.clear();
    if (alone) moment.number = numbersAlone + other_.framesOfSame();
    other_.setLook(now.pipeline.needsExposure() ? look_ : Look{});
    other_.prepare(stage, now, state.samples, now.pipeline.needsExposure() ? state.exposure : 0.0f);
    other_.render(std::move(moment));
    ++frames_;
    name_ = choice;
    if (other_.accumulates()) name_ += ", " + countText(other_.samples(), "sample");
}

void LiveComparison::update(LiveRender& main, float exposure, bool rendering) {
    if (!main || !other_) return;
    other_.setLook(other_.settings().pipeline.needsExposure() ? look_ : Look{});
    other_.expose(other_.settings().pipeline.needsExposure() ? exposure : 0.0f);
    const std::tuple now(main.frames(), frames_, exposure);
    const auto time = std::chrono::steady_clock::now();
    if (scores_.busy() || scored_ == now || (rendering && time - lastScores_ < betweenScores)) return;
    lastScores_ = time;
    scored_ = now;
    image::Image test = beautyOf(main.renderer().download()),
                 reference = beautyOf(other_.renderer().download());
    if (test.width == reference.width && test.height == reference.height)
        scores_.compare(std::move(test), std::move(reference), exposure);
}

}  // namespace limpid::studio
