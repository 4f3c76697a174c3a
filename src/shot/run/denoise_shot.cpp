#include "shot/run/denoise_shot.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <string>

#include "base/error.h"
#include "renderer/layers/picture_name.h"
#include "shot/explain.h"
#include "shot/run/cut_finder.h"
#include "shot/run/frame_reader.h"
#include "shot/run/frame_writer.h"
#include "shot/run/packed_picture.h"

namespace limpid::shot {
namespace {

void warnOf(const LoadedFrame& frame, const ShotJob& job) {
    for (const std::string& text : frame.warnings) warn(job, text);
    for (const LayerInfo* layer : frame.lacking)
        warn(job, fmt::format("the layer '{}' is missing: {}", layer->name, layer->without));
    if (const std::string variances = explainVariances(frame); !variances.empty()) warn(job, variances);
    const bool needsMotion = job.load.sequence && !job.load.network;
    for (const LayerMap& map : frame.maps)
        for (const RoleInfo& role : roles())
            if (!frame.own && !map.find(role.name) && role.isImportant &&
                (needsMotion || role.name != "motion"))
                warn(job, fmt::format("the layer '{}' is missing: {}", role.name, withoutRole(map, role)));
}

class ShotRun {
  public:
    ShotRun(const ShotJob& job, gpu::Device& device)
        : job_(job),
          device_(device),
          reader_(job),
          denoiser_(device, job.options, Direction::Forwards),
          cuts_(job),
          writer_(job),
          first_(job.firstWritten) {}

    ShotSummary run() {
        const auto start = std::chrono::steady_clock::now();
        for (const std::string& text : job_.warnings) warn(job_, text);
        if (!job_.resume || keepComplete()) denoiseFrames();
        writer_.finish();
        summary_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        summary_.skipped.assign(reader_.skipped().begin(), reader_.skipped().end());
        checkSomeFrameWasRead(job_, summary_);
        return summary_;
    }

  private:
    /// Asked often, so that run-ups and backward runs can be stopped, too, and others see that this process
    /// lives.
    bool goesOn(size_t done) {
        summary_.stopped = job_.progress && !job_.progress(done, job_.endWritten - first_);
        return !summary_.stopped;
    }

    /// Moves `first_` to the first frame that is not complete. Returns false if the run is stopped.
    bool keepComplete() {
        const std::optional<size_t> found = firstIncomplete(job_, reader_, [this] { return goesOn(0); });
        if (!found) return false;
        const auto at = [this](size_t index) { return job_.frames.begin() + static_cast<ptrdiff_t>(index); };
        summary_.kept = static_cast<int>(std::count_if(
            at(first_), at(*found), [this](int frame) { return !reader_.skipped().contains(frame); }));
        first_ = *found;
        return true;
    }

    /// How many frames before the first one are denoised for its history. Networks have none.
    size_t runUp() const {
        const bool isAlone = job_.options.method->network && !job_.options.keepsAntialiasing;
        return isAlone || first_ >= job_.endWritten ? 0 : std::min(first_, runUpFrames);
    }

    void denoiseFrames() {
        for (size_t i = first_ - runUp(); i < job_.endWritten; ++i) {
            const bool isWritten = i >= first_;
            const bool blockBegins = isWritten && (i - first_) % blockFrames == 0;
            if (job_.bidirectional && blockBegins && !goBackwards(i)) return;
            const bool blockEnds = i + 1 >= first_ && (i + 1 - first_) % blockFrames == 0;
            const bool readsOn = i + 1 < job_.endWritten && !(job_.bidirectional && blockEnds);
            std::optional<LoadedFrame> frame = reader_.read(i, readsOn ? std::optional(i + 1) : std::nullopt);
            if (frame) goForwards(std::move(*frame), isWritten);
            if (goesOn(isWritten ? i + 1 - first_ : 0)) continue;
            summary_.stopped = i + 1 < job_.endWritten;
            return;
        }
    }

    /// Denoises the block from its run-up down to its first frame. Returns false if the run is stopped.
    bool goBackwards(size_t first) {
        const size_t end = std::min(first + blockFrames, job_.endWritten);
        const size_t from = std::min(end + runUpFrames, job_.frames.size());
        ShotDenoiser denoiser(device_, job_.options, Direction::Backwards);
        CutFinder cuts(job_);
        backwards_.clear();
        std::optional<int> later;
        for (size_t i = from; i-- > first;) {
            if (!goesOn(first - first_)) return false;
            std::optional<LoadedFrame> frame =
                reader_.read(i, i > first ? std::optional(i - 1) : std::nullopt);
            if (!frame) continue;
            const bool cut = cuts.isCut(*frame);
            const bool continues = later && !cut && frame->number + 1 == *later;
            later = frame->number;
            const std::vector<CleanPicture> pictures = denoiser.denoise(*frame, continues);
            if (i >= end) continue;
            std::vector<PackedPicture>& packed = backwards_[frame->number];
            for (const CleanPicture& picture : pictures) packed.emplace_back(picture);
        }
        return true;
    }

    /// `isWritten`: else the frame only makes histories.
    void goForwards(LoadedFrame frame, bool isWritten) {
        const bool first = !last_, cut = cuts_.isCut(frame);
        const bool exr = isExr(job_.output.format(0));
        if (first) {
            warnOf(frame, job_);
            for (const LayerMap& map : frame.maps)
                if (exr) checkReplaceable(frame.file, map);
        }
        if (cut && !first && isWritten) summary_.cuts.push_back(frame.number);
        // Motion leads to the frame before, so after a gap it leads nowhere.
        const bool continues = !first && !cut && frame.number == *last_ + 1;
        last_ = frame.number;
        FrameToWrite result;
        if (!exr) result.surfaces = surfacesOf(frame);
        result.pictures = denoiser_.denoise(frame, continues);
        if (!isWritten) return;
        ++summary_.frames;
        finishPictures(frame, result.pictures);
        if (job_.afterFrame) job_.afterFrame(frame.number, denoiser_.graph(0));
        result.content = frame.content;
        result.file = std::move(frame.file);
        result.maps = std::move(frame.maps);
        writer_.write(frame.number, std::move(result));
    }

    void warnOfPicture(const LoadedFrame& frame, const CleanPicture& picture) {
        for (const std::string& problem : picture.report.problems)
            if (said_.insert(problem).second) warn(job_, problem);
        const uint64_t notFinite = std::max(picture.disocclusion.rejected, picture.report.notFinite);
        const char* const fate =
            frame.own ? "they were left out" : "infinite sky and lamps become 65504, others were left out";
        if (notFinite > 0)
            warn(job_, fmt::format("{}: {} pixels are NaN or infinite: {}", frame.file.name().string(),
                                   notFinite, fate));
    }

    /// Merges both directions.
    void finishPictures(const LoadedFrame& frame, std::vector<CleanPicture>& pictures) {
        const auto later = backwards_.find(frame.number);
        for (size_t i = 0; i < pictures.size(); ++i) {
            warnOfPicture(frame, pictures[i]);
            if (later != backwards_.end() && i < later->second.size())
                merge(pictures[i], later->second[i].unpacked());
        }
    }

    const ShotJob& job_;
    gpu::Device& device_;
    FrameReader reader_;
    ShotDenoiser denoiser_;
    CutFinder cuts_;
    FrameWriter writer_;
    size_t first_;  ///< index of the first frame that is written
    ShotSummary summary_;
    std::map<int, std::vector<PackedPicture>> backwards_;  ///< of the block, by frame and picture
    std::optional<int> last_;
    std::set<std::string> said_;  ///< warnings that are not repeated for each frame
};

}  // namespace

ShotSummary denoiseShot(const ShotJob& job, gpu::Device& device) {
    return ShotRun(job, device).run();
}

void checkSomeFrameWasRead(const ShotJob& job, const ShotSummary& summary) {
    const bool isWhole = job.firstWritten == job.firstAsked && job.endWritten == job.endAsked;
    if (isWhole && !summary.stopped && summary.frames == 0 && summary.kept == 0)
        throw InputError(job.input.text(), "no frame could be read");
}

}  // namespace limpid::shot
