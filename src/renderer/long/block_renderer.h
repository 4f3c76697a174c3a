// Renders a frame's samples block by block (renderer/long/block_plan.h) into exact sums.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "renderer/frame/frame_renderer.h"
#include "renderer/long/sums/accumulation.h"
#include "renderer/sequence/sequence.h"

namespace limpid {

/// The plan of a frame. Samples per launch are those of the settings, limited by block and device.
BlockPlan planBlocks(const gpu::Device& device, const RenderSettings& settings, uint64_t samples);

class BlockRenderer {
  public:
    /// `frames` must outlive this. Its number of samples does not matter.
    BlockRenderer(FrameRenderer& frames, const BlockPlan& plan) : frames_(frames), plan_(plan) {}

    /// Goes to a frame of a sequence, or to the one frame of a still, without motion blur.
    void begin(Moment moment);
    /// The same with motion blur, if the sequence has it: launches of the frame then see different instants.
    void begin(const Sequence& sequence, uint64_t frame);

    /// Renders the samples of a block, launch by launch, as long as `proceed(samples of this block so far)`
    /// is true before a launch. Returns how many samples were rendered: plan.samplesOf(block), or fewer.
    uint32_t render(uint32_t block, const std::function<bool(uint32_t)>& proceed);

    /// The samples of a render(), a whole block or a part of one.
    struct Result {
        uint32_t block = 0, samples = 0;
        std::map<const LayerInfo*, std::vector<float>> means;
        std::vector<uint32_t> ids;
        SampleCounts counts;
    };
    /// Downloads the layers of `sums` from the last render(). Waits for the device. Then it is free for the
    /// next block, even before the result is added.
    Result take(const FrameSums& sums);
    /// Adds a result on the host, which can take as long as rendering it.
    void add(Result result, FrameSums& sums);
    void addTo(FrameSums& sums) { add(take(sums), sums); }

    /// Adds the samples so far of the render() that is going on, as a part of a block, and counts nothing.
    void peek(FrameSums& sums);

    /// Total over all blocks that were added to sums.
    const SampleCounts& counts() const { return counts_; }

  private:
    void showInstant(uint64_t launch);

    FrameRenderer& frames_;
    BlockPlan plan_;
    uint64_t frame_ = 0;
    const Sequence* blurred_ = nullptr;  ///< where each launch gets its instant from; none: no motion blur
    uint32_t block_ = 0;
    SampleCounts counts_;
};

}  // namespace limpid
