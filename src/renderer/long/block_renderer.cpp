#include "renderer/long/block_renderer.h"

#include <algorithm>
#include <utility>

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

BlockRenderer::Result BlockRenderer::take(const FrameSums& sums) {
    Result result{.block = block_, .samples = static_cast<uint32_t>(frames_.samplesInMean())};
    if (result.samples == 0) throw Error("nothing has been rendered yet");
    for (const LayerSums& layer : sums.layers) result.means[layer.info] = frames_.download(*layer.info);
    if (block_ == 0 && sums.wantsIds) result.ids = frames_.ids();
    const RenderCounters counters = frames_.counters();
    result.counts = {.rays = counters.rays, .rejected = counters.rejected};
    return result;
}

void BlockRenderer::add(Result result, FrameSums& sums) {
    const auto meansOf = [&](const LayerInfo& layer) { return std::move(result.means.at(&layer)); };
    const uint64_t clampedBefore = sums.counts.clamped;
    if (result.samples == plan_.samplesOf(result.block)) {
        sums.addBlock(result.block, meansOf);
    } else {
        sums.addPart(result.samples, meansOf);
    }
    if (result.block == 0 && sums.wantsIds) sums.ids = std::move(result.ids);
    sums.counts += result.counts;
    result.counts.clamped = sums.counts.clamped - clampedBefore;
    counts_ += result.counts;
}

}  // namespace limpid
