// Renders a still or a sequence: with a time limit, with checkpoints, in shards, or without any of them. The
// result is the same to the bit.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <vector>

#include "renderer/long/block_renderer.h"
#include "renderer/long/checkpoint.h"
#include "renderer/sequence/sequence.h"

namespace limpid {

/// Callbacks of a long render.
struct LongRenderEvents {
    /// Called with the samples per pixel that this run has launched so far, over all frames.
    std::function<void(uint64_t samples)> progress;
    /// Called with the sums for a picture or a shard's file. They are complete, unless a still ran out of
    /// time.
    std::function<void(uint64_t frame, const FrameSums& sums)> finish;
    /// Called with the sums so far of a still; see setPreview().
    std::function<void(const FrameSums& sums)> preview;
    /// Whether the output of finish() for a frame still exists. If not, the frame is rendered again.
    std::function<bool(uint64_t frame)> isThere;
};

class LongRender {
  public:
    using Clock = std::chrono::steady_clock;

    /// `header` describes the render, the frames and the shard; rendering starts at its `frame` and
    /// `finished`.
    LongRender(BlockRenderer& renderer, const Sequence& sequence, AccumulationHeader header);

    /// No launch starts after this time, except that a still gets at least one.
    void setDeadline(Clock::time_point deadline) { deadline_ = deadline; }
    /// From when this is true, no launch starts either, as after the deadline.
    void setStop(std::function<bool()> stop) { stop_ = std::move(stop); }
    /// Calls LongRenderEvents::preview this often, between launches.
    void setPreview(std::chrono::duration<double> every) { previewEvery_ = every; }
    /// Writes checkpoints from now on. With `resume`, continues from the file if it exists. Throws like
    /// Checkpoint.
    void setCheckpoint(Checkpoint checkpoint, bool resume);

    /// Remaining samples per pixel over all frames of the shard.
    uint64_t samplesToDo() const;
    /// Renders the rest. Returns false if time ran out first.
    bool run(const LongRenderEvents& events);
    /// True if run() could not write the checkpoint at its end.
    bool lostState() const { return lostState_; }

    uint64_t blocksFinished() const { return blocks_; }  ///< by this run
    uint64_t framesFinished() const;                     ///< of this shard, including earlier runs
    uint64_t framesToDo() const { return finished_.size(); }
    double renderSeconds() const { return seconds_; }
    const AccumulationHeader& header() const { return header_; }

  private:
    bool isStill() const { return header_.frames == 1; }
    bool isStillShard() const { return isStill() && header_.shard.count > 1; }
    uint64_t frameOf(uint64_t k) const { return isStill() ? 0 : header_.shard.at(k); }
    bool hasBlock(uint32_t block) const { return !isStill() || header_.shard.has(block); }
    bool timeIsUp() const { return (stop_ && stop_()) || (deadline_ && Clock::now() >= *deadline_); }
    uint64_t samplesMissing(const FrameSums& sums) const;
    FrameSums newSums() const { return {header_.extent, header_.plan, header_.layers}; }
    bool renderFrame(uint64_t k, const LongRenderEvents& events);
    bool renderBlocks(FrameSums& sums, const LongRenderEvents& events);
    bool previewIsDue() const {
        return previewEvery_.count() > 0.0 && Clock::now() - previewed_ >= previewEvery_;
    }
    void showPreview(const FrameSums& sums, uint32_t done, const LongRenderEvents& events);
    void saveState(const FrameSums& sums, bool last);

    BlockRenderer& renderer_;
    const Sequence& sequence_;
    AccumulationHeader header_;
    std::optional<Clock::time_point> deadline_;
    std::function<bool()> stop_;
    std::chrono::duration<double> previewEvery_{};  ///< 0: never
    Clock::time_point previewed_;
    std::optional<Checkpoint> checkpoint_;
    std::optional<FrameSums> resumed_;  ///< sums of header_.frame
    std::vector<bool> finished_;        ///< by number within the shard; a still is one frame
    bool lostState_ = false;
    uint64_t launched_ = 0;  ///< samples per pixel
    uint64_t blocks_ = 0;
    double seconds_ = 0.0;
};

}  // namespace limpid
