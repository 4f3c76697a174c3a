#include "shot/run/denoise_shot.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>

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
    for (const LayerInfo* layer : frame.lacking)
        warn(job, fmt::format("the layer '{}' is missing: {}", layer->name, layer->without));
    for (const std::string& text : job.warnings) warn(job, text);
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
          first_(job.resume ? firstIncomplete(job) : job.firstWritten) {}

    ShotSummary run() {
        const auto start = std::chrono::steady_clock::now();
        summary_.kept = static_cast<int>(first_ - job_.firstWritten);
        const size_t runUp = std::min(first_, runUpFrames);
        for (size_t i = first_ - (first_ < job_.endWritten ? runUp : 0); i < job_.endWritten; ++i) {
            const bool blockBegins = i >= first_ && (i - first_) % blockFrames == 0;
            if (job_.bidirectional && blockBegins) goBackwards(i);
            const bool blockEnds = i + 1 >= first_ && (i + 1 - first_) % blockFrames == 0;
            const bool readsOn = i + 1 < job_.endWritten && !(job_.bidirectional && blockEnds);
            std::optional<LoadedFrame> frame = reader_.read(i, readsOn ? std::optional(i + 1) : std::nullopt);
            if (frame) goForwards(std::move(*frame), i >= first_);
            if (i >= first_ && job_.progress && !job_.progress(i + 1 - first_, job_.endWritten - first_)) {
                summary_.stopped = i + 1 < job_.endWritten;
                break;
            }
        }
        writer_.finish();
        summary_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        summary_.skipped.assign(reader_.skipped().begin(), reader_.skipped().end());
        if (summary_.frames == 0 && summary_.kept == 0 && first_ < job_.endWritten)
            throw InputError(job_.input.text(), "no frame could be read");
        return summary_;
    }

  private:
    /// Denoises the block from its run-up down to its first frame.
    void goBackwards(size_t first) {
        const size_t end = std::min(first + blockFrames, job_.endWritten);
        const size_t from = std::min(end + runUpFrames, job_.frames.size());
        ShotDenoiser denoiser(device_, job_.options, Direction::Backwards);
        CutFinder cuts(job_);
        backwards_.clear();
        std::optional<int> later;
        for (size_t i = from; i-- > first;) {
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
        if (cut && !first) summary_.cuts.push_back(frame.number);
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

    /// Merges both directions.
    void finishPictures(const LoadedFrame& frame, std::vector<CleanPicture>& pictures) const {
        const auto later = backwards_.find(frame.number);
        for (size_t i = 0; i < pictures.size(); ++i) {
            if (const uint64_t rejected = pictures[i].disocclusion.rejected; rejected > 0)
                warn(job_, fmt::format("{}: {} pixels are NaN or infinite and were left out",
                                       frame.file.name().string(), rejected));
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
};

}  // namespace

ShotSummary denoiseShot(const ShotJob& job, gpu::Device& device) {
    return ShotRun(job, device).run();
}

}  // namespace limpid::shot
