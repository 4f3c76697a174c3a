// A still or a sequence from its first block to its last picture: with a time limit, with checkpoints, in
// shards, or plainly. All ways give the same bits.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <vector>

#include "renderer/frame/sequence.h"
#include "renderer/long/block_renderer.h"
#include "renderer/long/checkpoint.h"

namespace limpid {

/// What a long render asks of its caller.
struct LongRenderEvents {
    /// Samples per pixel that this run has launched, over all frames.
    std::function<void(uint64_t samples)> progress;
    /// To be called with the sums that a picture, or a shard's file, is made of: whole, or of a still that
    /// ran out of time.
    std::function<void(uint64_t frame, const FrameSums& sums)> finish;
    /// Whether what finish() made of a frame is still there. A frame without it is rendered again.
    std::function<bool(uint64_t frame)> isThere;
};

class LongRender {
  public:
    using Clock = std::chrono::steady_clock;

    /// `header` says which render, frames and shard; its `frame` and `finished` are where to start.
    LongRender(BlockRenderer& renderer, const Sequence& sequence, AccumulationHeader header);

    /// No launch begins after this time, but that a still has one.
    void setDeadline(Clock::time_point deadline) { deadline_ = deadline; }
    /// Writes checkpoints from now on; with `resume`, goes on where the file left off, if there is one.
    /// Throws as Checkpoint does.
    void setCheckpoint(Checkpoint checkpoint, bool resume);

    /// Of all frames of the shard, samples per pixel that are still to be made.
    uint64_t samplesToDo() const;
    /// Renders what is to be done. False if time ran out first.
    bool run(const LongRenderEvents& events);

    uint64_t blocksFinished() const { return blocks_; }  ///< by this run
    uint64_t framesFinished() const;                     ///< of this shard, by this run and those before
    uint64_t framesToDo() const { return finished_.size(); }
    double renderSeconds() const { return seconds_; }
    const AccumulationHeader& header() const { return header_; }

  private:
    bool isStill() const { return header_.frames == 1; }
    bool isStillShard() const { return isStill() && header_.shard.count > 1; }
    uint64_t frameOf(uint64_t k) const { return isStill() ? 0 : header_.shard.at(k); }
    bool hasBlock(uint32_t block) const { return !isStill() || header_.shard.has(block); }
    bool timeIsUp() const { return deadline_ && Clock::now() >= *deadline_; }
    uint64_t samplesMissing(const FrameSums& sums) const;
    FrameSums newSums() const { return {header_.extent, header_.plan, header_.layers}; }
    bool renderFrame(uint64_t k, const LongRenderEvents& events);
    bool renderBlocks(FrameSums& sums, const LongRenderEvents& events);
    void saveState(const FrameSums& sums, bool now);

    BlockRenderer& renderer_;
    const Sequence& sequence_;
    AccumulationHeader header_;
    std::optional<Clock::time_point> deadline_;
    std::optional<Checkpoint> checkpoint_;
    std::optional<FrameSums> resumed_;  ///< of header_.frame
    std::vector<bool> finished_;        ///< by number within the shard; a still is one frame
    uint64_t launched_ = 0;             ///< samples per pixel
    uint64_t blocks_ = 0;
    double seconds_ = 0.0;
};

}  // namespace limpid
