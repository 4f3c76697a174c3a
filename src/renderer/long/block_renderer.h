// Renders a frame's samples block by block (renderer/long/block_plan.h) into exact sums.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "renderer/frame/still.h"
#include "renderer/long/accumulation.h"

namespace limpid {

/// The plan of a frame. Samples per launch are those of the settings, limited by block and device.
BlockPlan planBlocks(const gpu::Device& device, const RenderSettings& settings, uint64_t samples);

class BlockRenderer {
  public:
    /// The scene must outlive this.
    BlockRenderer(gpu::Device& device, scene::GpuScene& scene, const RenderSettings& settings,
                  const BlockPlan& plan);

    /// Goes to a frame of a sequence, or to the one frame of a still.
    void begin(Moment moment);

    /// Renders the samples of a block, launch by launch, as long as `proceed(samples of this block so far)`
    /// is true before a launch. Returns how many samples were rendered: plan.samplesOf(block), or fewer.
    uint32_t render(uint32_t block, const std::function<bool(uint32_t)>& proceed);

    /// Adds the samples of the last render(), a whole block or a part of one. Waits for the device.
    void addTo(FrameSums& sums);

    bool hasLaunched() const { return launched_; }
    /// Total over all blocks that were added to sums.
    const SampleCounts& counts() const { return counts_; }
    std::vector<gpu::PassTime> passTimes() { return graph_.passTimes(device_); }
    std::vector<std::pair<std::string, image::Image>> dump(const std::string& pass) {
        return imagesOfPass(graph_, device_, pass);
    }

  private:
    void launch(uint32_t samples);
    SampleCounts countsOfBlock();

    gpu::Device& device_;
    scene::GpuScene& scene_;
    RenderSettings settings_;
    BlockPlan plan_;
    gpu::FrameGraph graph_;
    Moment moment_;
    FrameImages images_;
    uint32_t block_ = 0, launchesDone_ = 0, samplesDone_ = 0;
    std::vector<uint32_t> ids_;  ///< ids of the first launch, whose first sample goes through the centre
    SampleCounts counts_;
    bool launched_ = false;
};

}  // namespace limpid
