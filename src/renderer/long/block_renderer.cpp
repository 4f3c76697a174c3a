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

BlockRenderer::BlockRenderer(gpu::Device& device, scene::GpuScene& scene, const RenderSettings& settings,
                             const BlockPlan& plan)
    : device_(device), scene_(scene), settings_(settings), plan_(plan) {}

void BlockRenderer::begin(Moment moment) {
    moment_ = std::move(moment);
    ids_.clear();
    samplesDone_ = 0;
}

uint32_t BlockRenderer::render(uint32_t block, const std::function<bool(uint32_t)>& proceed) {
    if (launched_) graph_.resetHistories();
    block_ = block;
    launchesDone_ = samplesDone_ = 0;
    const uint32_t wanted = plan_.samplesOf(block);
    while (samplesDone_ < wanted && proceed(samplesDone_))
        launch(std::min(plan_.launchSamples, wanted - samplesDone_));
    return samplesDone_;
}

void BlockRenderer::launch(uint32_t samples) {
    FrameInput input{.camera = moment_.camera,
                     .previousCamera = moment_.previousCamera.value_or(moment_.camera)};
    input.hasPrevious = moment_.previousCamera.has_value();
    input.moved = moment_.scene ? &*moment_.scene : nullptr;
    // Random numbers continue across blocks; the means restart in each.
    const uint32_t launchOfFrame = plan_.firstLaunch(block_) + launchesDone_;
    input.firstSample = block_ * plan_.blockSamples + samplesDone_;  // at most maxSamplesPerPixel
    input.stream = moment_.number * plan_.launches() + launchOfFrame;
    input.samplesBefore = samplesDone_;
    input.samples = samples;
    graph_.beginFrame();
    images_ = recordFrame(graph_, scene_, settings_, input);
    graph_.execute(device_);
    moment_.scene.reset();  // the device keeps this state until the next frame
    if (launchOfFrame == 0 && images_.ids) ids_ = graph_.downloadUint(device_, images_.ids);
    samplesDone_ += samples;
    ++launchesDone_;
    launched_ = true;
}

SampleCounts BlockRenderer::countsOfBlock() {
    const RenderCounters sum = sumCounters(graph_.downloadUint(device_, images_.counters));
    return {.rays = sum.rays, .rejected = sum.rejected};
}

void BlockRenderer::addTo(FrameSums& sums) {
    if (samplesDone_ == 0) throw Error("nothing has been rendered yet");
    const auto meansOf = [&](const LayerInfo& layer) {
        return graph_.downloadFloat(device_, images_[layer]);
    };
    const uint64_t clampedBefore = sums.counts.clamped;
    if (samplesDone_ == plan_.samplesOf(block_)) {
        sums.addBlock(block_, meansOf);
    } else {
        sums.addPart(samplesDone_, meansOf);
    }
    if (block_ == 0 && sums.wantsIds) sums.ids = ids_;
    SampleCounts added = countsOfBlock();
    sums.counts += added;
    added.clamped = sums.counts.clamped - clampedBefore;
    counts_ += added;
}

}  // namespace limpid
