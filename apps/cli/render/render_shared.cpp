// `limpid render` by the processes of a cluster. Sums are integers, so the picture does not depend on who
// rendered what.
#include <algorithm>
#include <mutex>
#include <optional>

#include "base/clock.h"
#include "base/files/file.h"
#include "cli/cluster/cluster_progress.h"
#include "cli/cluster/session.h"
#include "cli/console/interrupt.h"
#include "cli/render/render_sampled.h"
#include "cli/render/sums_message.h"
#include "renderer/long/block_renderer.h"
#include "renderer/long/checkpoint.h"

namespace limpid::cli {
namespace {

namespace fs = std::filesystem;
using cluster::Bytes;
using cluster::BytesView;

/// What stills and sequences share: the renderer, the clock, the checkpoint, and the counters.
class SharedFrames {
  public:
    explicit SharedFrames(const RenderJob& job)
        : job_(job),
          header_(headerOf(job)),
          frames_(job.device, job.scene, job.settings, header_.plan.samples),
          renderer_(frames_, header_.plan) {
        const LongRenderChoice& o = job.options.longRender;
        if (o.timeLimit > 0.0)
            deadline_ = job.started + std::chrono::duration_cast<Clock::duration>(
                                          std::chrono::duration<double>(o.timeLimit));
        if (!o.checkpoint.empty() && isFirstProcess()) checkpoint_.emplace(o.checkpoint);
        work_.identity = renderHash(header_);
        work_.device = header_.device + ", " + header_.driver + ", tracer " + header_.tracer;
    }

  protected:
    FrameSums newSums() const { return {header_.extent, header_.plan, header_.layers}; }
    bool timeIsUp() const { return interrupted() || (deadline_ && Clock::now() >= *deadline_); }
    bool resumes() const { return checkpoint_ && job_.options.longRender.resume && checkpoint_->exists(); }
    /// Between launches of a block.
    bool goesOn() {
        ranks()->beat();
        return !timeIsUp();
    }
    void report(RenderSummary& summary, Clock::time_point start) {
        summary.timings.renderSeconds = std::chrono::duration<double>(Clock::now() - start).count();
        summary.counts = renderer_.counts();
        summary.counts += others_;
        if (frames_.hasLaunched()) summary.lastFrame = sumByName(frames_.passTimes());
    }

    const RenderJob& job_;
    AccumulationHeader header_;
    FrameRenderer frames_;
    BlockRenderer renderer_;
    std::optional<Clock::time_point> deadline_;
    std::optional<Checkpoint> checkpoint_;  ///< process 0 has it
    SampleCounts others_;                   ///< of other processes, on process 0
    cluster::SharedWork work_;
};

/// Pieces are blocks.
class SharedStill : SharedFrames {
  public:
    explicit SharedStill(const RenderJob& job) : SharedFrames(job), sums_(newSums()) {}

    void run(RenderSummary& summary) {
        if (resumes()) sums_ = checkpoint_->load(header_).sums;
        for (uint32_t block = 0; block < sums_.blocks.size(); ++block)
            if (!sums_.blocks[block]) work_.todo.push_back(block);
        ClusterProgress progress("blocks", work_.todo.size());
        work_.collectsEarly = checkpoint_.has_value();
        work_.make = [&](uint64_t block) { return render(static_cast<uint32_t>(block)); };
        work_.collect = [&] { return encodeSums(std::exchange(sums_, newSums())); };
        work_.add = [&](BytesView bytes) { add(bytes); };
        work_.finished = [&](const std::vector<uint64_t>&, uint64_t count) {
            progress.show(count);
            const std::lock_guard lock(mutex_);
            if (checkpoint_) checkpoint_->saveIfDue(header_, sums_);
        };
        const bool anyToDo = !work_.todo.empty();
        const Clock::time_point start = Clock::now();
        summary.piecesByProcess = ranks()->share(work_);
        if (!isFirstProcess()) return;
        for (const uint64_t count : summary.piecesByProcess) summary.blocksFinished += count;
        summary.complete = sums_.complete();
        if (checkpoint_ && anyToDo) summary.lostState = !checkpoint_->saveLast(header_, sums_);
        addPart();
        report(summary, start);
        summary.samples = sums_.samples();
        summary.framesToDo = 1;
        summary.framesFinished = summary.complete ? 1 : 0;
        writeSampled(job_, header_, 0, sums_, frames_);
    }

  private:
    bool render(uint32_t block) {
        if (!begun_) renderer_.begin(job_.sequence, 0);
        begun_ = true;
        made_ = renderer_.render(block, [&](uint32_t) { return goesOn(); });
        if (made_ != header_.plan.samplesOf(block)) return false;
        made_ = 0;
        const std::lock_guard lock(mutex_);
        renderer_.addTo(sums_);
        return true;
    }

    void add(BytesView bytes) {
        const FrameSums other = decodeSums(bytes, newSums());
        others_ += other.counts;
        const std::lock_guard lock(mutex_);
        sums_.merge(other);
    }

    /// If time was up: what process 0 has of a block that is not complete. A picture has one launch at least.
    void addPart() {
        if (made_ == 0 && sums_.samples() == 0) {
            if (!begun_) renderer_.begin(job_.sequence, 0);
            made_ = renderer_.render(0, [](uint32_t done) { return done == 0; });
        }
        if (made_ > 0) renderer_.addTo(sums_);
    }

    FrameSums sums_;  ///< on process 0 of all, elsewhere of what has not been collected
    std::mutex mutex_;
    bool begun_ = false;
    uint32_t made_ = 0;  ///< samples of a block that is not complete
};

/// Pieces are frames; each process writes the files of its own.
class SharedSequence : SharedFrames {
  public:
    explicit SharedSequence(const RenderJob& job)
        : SharedFrames(job), output_(job.options.output), fileHeader_(header_) {}

    void run(RenderSummary& summary) {
        std::vector<bool> finished = finishedFrames();
        for (uint64_t frame = 0; frame < header_.frames; ++frame)
            if (!finished[frame]) work_.todo.push_back(frame);
        const uint64_t before = header_.frames - work_.todo.size();
        ClusterProgress progress("frames", work_.todo.size());
        work_.make = [&](uint64_t frame) { return render(frame); };
        work_.farewell = [&] { return encodeCounts(renderer_.counts()); };
        work_.addFarewell = [&](BytesView bytes) { others_ += decodeCounts(bytes); };
        work_.finished = [&](const std::vector<uint64_t>& frames, uint64_t count) {
            for (const uint64_t frame : frames) finished[frame] = true;
            progress.show(count);
            if (!checkpoint_) return;
            setFinished(finished);
            checkpoint_->saveIfDue(header_, newSums());
        };
        const Clock::time_point start = Clock::now();
        summary.piecesByProcess = ranks()->share(work_);
        if (!isFirstProcess()) return;
        if (checkpoint_) {
            setFinished(finished);
            summary.lostState = !checkpoint_->saveLast(header_, newSums());
        }
        report(summary, start);
        summary.framesToDo = header_.frames;
        summary.framesFinished = static_cast<uint64_t>(std::count(finished.begin(), finished.end(), true));
        summary.blocksFinished = (summary.framesFinished - before) * header_.plan.blocks();
        summary.complete = summary.framesFinished == summary.framesToDo;
        summary.samples = summary.framesFinished > 0 ? header_.plan.samples : 0;
    }

  private:
    fs::path fileOf(uint64_t frame) const { return output_.format(static_cast<int>(frame)); }

    std::vector<bool> finishedFrames() const {
        std::vector<bool> finished(header_.frames);
        if (!resumes()) return finished;
        for (const auto& [first, last] : checkpoint_->load(header_).header.finished)
            for (uint64_t frame = first; frame <= last; ++frame) finished[frame] = fs::exists(fileOf(frame));
        return finished;
    }

    void setFinished(const std::vector<bool>& finished) {
        header_.finished.clear();
        for (uint64_t frame = 0; frame < finished.size(); ++frame) {
            if (!finished[frame]) continue;
            if (header_.finished.empty() || header_.finished.back().second + 1 != frame)
                header_.finished.emplace_back(frame, frame);
            header_.finished.back().second = frame;
        }
    }

    bool render(uint64_t frame) {
        FrameSums sums = newSums();
        renderer_.begin(job_.sequence, frame);
        for (uint32_t block = 0; block < sums.blocks.size(); ++block) {
            if (renderer_.render(block, [&](uint32_t) { return goesOn(); }) != header_.plan.samplesOf(block))
                return false;
            renderer_.addTo(sums);
        }
        writeSampled(job_, fileHeader_, frame, sums, frames_);
        return true;
    }

    FramePattern output_;
    const AccumulationHeader fileHeader_;  ///< header_ changes while frames are written
};

}  // namespace

void renderSharedFrames(const RenderJob& job, RenderSummary& summary) {
    if (job.frames == 1) {
        SharedStill(job).run(summary);
    } else {
        SharedSequence(job).run(summary);
    }
}

}  // namespace limpid::cli
