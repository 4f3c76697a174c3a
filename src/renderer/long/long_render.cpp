#include "renderer/long/long_render.h"

#include <algorithm>
#include <future>

#include "base/log.h"

namespace limpid {
namespace {

using Ranges = std::vector<std::pair<uint64_t, uint64_t>>;

Ranges rangesOf(const std::vector<bool>& set) {
    Ranges ranges;
    for (size_t i = 0; i < set.size(); ++i) {
        if (!set[i]) continue;
        if (!ranges.empty() && ranges.back().second + 1 == i) {
            ranges.back().second = i;
        } else {
            ranges.emplace_back(i, i);
        }
    }
    return ranges;
}

}  // namespace

LongRender::LongRender(BlockRenderer& renderer, const Sequence& sequence, AccumulationHeader header)
    : renderer_(renderer),
      sequence_(sequence),
      header_(std::move(header)),
      finished_(isStill() ? 1 : header_.shard.countOf(header_.frames)) {}

void LongRender::setCheckpoint(Checkpoint checkpoint, bool resume) {
    checkpoint_ = std::move(checkpoint);
    if (!resume || !checkpoint_->exists()) return;
    Accumulation loaded = checkpoint_->load(header_);
    header_.frame = loaded.header.frame;
    resumed_ = std::move(loaded.sums);
    if (isStill()) return;
    for (const auto& [first, last] : loaded.header.finished) {
        for (uint64_t k = first; k <= last; ++k) finished_[k] = true;
    }
}

uint64_t LongRender::samplesMissing(const FrameSums& sums) const {
    uint64_t samples = 0;
    for (uint32_t block = 0; block < sums.blocks.size(); ++block) {
        if (hasBlock(block) && !sums.blocks[block]) samples += sums.plan.samplesOf(block);
    }
    return samples;
}

uint64_t LongRender::samplesToDo() const {
    uint64_t samples = 0;
    const uint64_t whole = samplesMissing(newSums());
    for (uint64_t k = 0; k < finished_.size(); ++k) {
        if (finished_[k]) continue;
        samples += resumed_ && frameOf(k) == header_.frame ? samplesMissing(*resumed_) : whole;
    }
    return samples;
}

uint64_t LongRender::framesFinished() const {
    return static_cast<uint64_t>(std::count(finished_.begin(), finished_.end(), true));
}

/// A checkpoint that cannot be written is no reason to lose the picture.
void LongRender::saveState(const FrameSums& sums, bool last) {
    if (!checkpoint_) return;
    if (!isStill()) header_.finished = rangesOf(finished_);
    if (last) {
        lostState_ = !checkpoint_->saveLast(header_, sums);
    } else {
        checkpoint_->saveIfDue(header_, sums);
    }
}

bool LongRender::run(const LongRenderEvents& events) {
    for (uint64_t k = 0; k < finished_.size(); ++k) {
        if (finished_[k] && !events.isThere(frameOf(k))) finished_[k] = false;
    }
    // Finish the frame that was begun first; otherwise its sums would be lost.
    for (uint64_t k = 0; k < finished_.size() && resumed_; ++k) {
        if (!finished_[k] && frameOf(k) == header_.frame && !renderFrame(k, events)) return false;
    }
    resumed_.reset();
    for (uint64_t k = 0; k < finished_.size(); ++k) {
        if (!finished_[k] && !renderFrame(k, events)) return false;
    }
    if (!isStill() && !finished_.empty()) saveState(newSums(), true);
    return true;
}

bool LongRender::renderFrame(uint64_t k, const LongRenderEvents& events) {
    FrameSums sums = newSums();
    if (resumed_) std::swap(sums, *resumed_);
    resumed_.reset();
    header_.frame = frameOf(k);
    if (!isStill() && timeIsUp()) {
        saveState(sums, true);
        return false;
    }
    if (samplesMissing(sums) > 0) renderer_.begin(sequence_, header_.frame);
    const bool whole = renderBlocks(sums, events);
    if (!whole && !isStill()) return false;
    if (sums.samples() > 0 || isStillShard()) events.finish(header_.frame, sums);
    if (!whole) return false;
    finished_[k] = true;
    // A still's checkpoint now has all samples; a sequence's needs no samples of a finished frame.
    if (!isStill()) saveState(newSums(), false);
    return true;
}

void LongRender::showPreview(const FrameSums& sums, uint32_t done, const LongRenderEvents& events) {
    FrameSums shown = sums;
    if (done > 0) renderer_.peek(shown);
    if (shown.samples() > 0) events.preview(shown);
    previewed_ = Clock::now();  // writing takes time
}

bool LongRender::renderBlocks(FrameSums& sums, const LongRenderEvents& events) {
    const Clock::time_point start = Clock::now();
    previewed_ = start;
    bool whole = true;
    const uint64_t before = launched_;
    const bool mustLaunch = isStill() && !isStillShard() && sums.samples() == 0;
    // Sums are added while the device renders the next block. Nothing else may look at them meanwhile.
    std::future<void> adding;
    const auto settle = [&] {
        if (adding.valid()) adding.get();
    };
    for (uint32_t block = 0; block < sums.blocks.size() && whole; ++block) {
        if (sums.blocks[block] || !hasBlock(block)) continue;
        const uint32_t made = renderer_.render(block, [&](uint32_t done) {
            events.progress(launched_ + done);
            if (previewIsDue()) {
                settle();
                showPreview(sums, done, events);
            }
            return !timeIsUp() || (mustLaunch && block == 0 && done == 0);
        });
        launched_ += made;
        whole = made == sums.plan.samplesOf(block);
        settle();
        if (!whole) {
            saveState(sums, true);
            if (made > 0 && isStill() && !isStillShard()) renderer_.addTo(sums);
        } else {
            adding = std::async(std::launch::async, [&, result = renderer_.take(sums)]() mutable {
                renderer_.add(std::move(result), sums);
            });
            ++blocks_;
            if (checkpoint_ && checkpoint_->isDue()) {
                settle();
                saveState(sums, false);
            }
        }
    }
    settle();
    if (whole && isStill() && launched_ > before) saveState(sums, true);
    seconds_ += std::chrono::duration<double>(Clock::now() - start).count();
    return whole;
}

}  // namespace limpid
