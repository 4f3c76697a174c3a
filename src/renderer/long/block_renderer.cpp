#include "renderer/long/block_renderer.h"

#include <algorithm>

#include "base/error.h"

namespace limpid {

BlockPlan planBlocks(const gpu::Device& device, const RenderSettings& settings, uint64_t samples) {
    BlockPlan plan;
    plan.samples = samples;
    plan.blockSamples = blockSamplesFor(samples);
    plan.launchSamples = std::min(samplesPerLaunch(device, settings), plan.blockSamples);
    return plan;
}

void BlockRenderer::begin(const Sequence& sequence, uint64_t frame) {
    begin(sequence.moment(frame, frames_.settings().extent));
    if (sequence.isBlurred()) blurred_ = &sequence;
}

void BlockRenderer::begin(Moment moment) {
    blurred_ = nullptr;
    frame_ = moment.number;
    frames_.begin(std::move(moment));
}

uint32_t BlockRenderer::render(uint32_t block, const std::function<bool(uint32_t)>& proceed) {
    // Random numbers continue across blocks; the means restart in each.
    frames_.restart();
    block_ = block;
    const uint64_t firstSample = uint64_t{block} * plan_.blockSamples;
    const uint32_t wanted = plan_.samplesOf(block);
    uint64_t launch = plan_.firstLaunch(block);
    uint32_t done = 0;
    while (done < wanted && proceed(done)) {
        const uint32_t count = std::min(plan_.launchSamples, wanted - done);
        const uint64_t first = firstSample + done;
        if (blurred_) showInstant(launch);
        frames_.launch({.stream = frame_ * plan_.launches() + launch++,
                        .first = first,
                        .point = frame_ * plan_.samples + first,
                        .count = count,
                        .alone = plan_.samples == 1});
        done += count;
    }
    return done;
}

void BlockRenderer::showInstant(uint64_t launch) {
    const RenderSettings& settings = frames_.settings();
    const double instant = shutterInstant(settings.seed, frame_, launch);
    frames_.moveOn(blurred_->momentDuring(frame_, instant, settings.extent));
}

void BlockRenderer::peek(FrameSums& sums) {
    const auto samples = static_cast<uint32_t>(frames_.samplesInMean());
    if (samples == 0) return;
    sums.addPart(samples, [&](const LayerInfo& layer) { return frames_.download(layer); });
    if (block_ == 0 && sums.wantsIds) sums.ids = frames_.ids();
}

void BlockRenderer::addTo(FrameSums& sums) {
    const auto samples = static_cast<uint32_t>(frames_.samplesInMean());
    if (samples == 0) throw Error("nothing has been rendered yet");
    const auto meansOf = [&](const LayerInfo& layer) { return frames_.download(layer); };
    const uint64_t clampedBefore = sums.counts.clamped;
    if (samples == plan_.samplesOf(block_)) {
        sums.addBlock(block_, meansOf);
    } else {
        sums.addPart(samples, meansOf);
    }
    if (block_ == 0 && sums.wantsIds) sums.ids = frames_.ids();
    const RenderCounters counters = frames_.counters();
    SampleCounts added{.rays = counters.rays, .rejected = counters.rejected};
    sums.counts += added;
    added.clamped = sums.counts.clamped - clampedBefore;
    counts_ += added;
}

}  // namespace limpid
