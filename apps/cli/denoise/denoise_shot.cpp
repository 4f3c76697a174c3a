#include "cli/denoise/denoise_shot.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <glm/gtc/packing.hpp>
#include <set>

#include "base/error.h"
#include "base/hash.h"
#include "base/log.h"
#include "cli/pass_times.h"
#include "cli/progress.h"
#include "cli/render/picture_output.h"
#include "cli/render/render_job.h"
#include "image/io/png/png.h"
#include "image/tonemap.h"
#include "renderer/frame/frame_download.h"
#include "shot/motion_check.h"

namespace limpid::cli {
namespace {

namespace fs = std::filesystem;
using shot::CleanPicture;
using shot::LoadedFrame;

/// Frames of a block of bidirectional shots. (Its backward run starts runUpFrames behind its end.)
constexpr size_t blockFrames = 32;

/// Reads frames, each while the last one is used.
class FrameReader {
  public:
    explicit FrameReader(const ShotJob& job) : job_(job) {}

    /// Returns the frame job.frames[index], and begins to read job.frames[next] if there is one. Nothing if
    /// the frame is unreadable and to be skipped.
    std::optional<LoadedFrame> read(size_t index, std::optional<size_t> next) {
        if (!reading_.valid() || ahead_ != index) start(index);
        std::future<LoadedFrame> current = std::move(reading_);
        std::optional<LoadedFrame> frame;
        try {
            frame = current.get();
            shot::unpack(*frame, job_.load);
        } catch (const InputError& error) {
            if (!job_.skipUnreadable || job_.frames.size() == 1) throw;
            frame.reset();
            if (skipped_.insert(job_.frames[index]).second)
                log::warn("{}; the frame is skipped", error.what());
        }
        if (next) start(*next);
        return frame;
    }

    const std::set<int>& skipped() const { return skipped_; }

  private:
    void start(size_t index) {
        ahead_ = index;
        reading_ = std::async(std::launch::async, [this, frame = job_.frames[index]] {
            return shot::loadFrame(job_.input.format(std::max(frame, 0)), frame, job_.load);
        });
    }

    const ShotJob& job_;
    std::future<LoadedFrame> reading_;
    size_t ahead_ = 0;
    std::set<int> skipped_;
};

/// Notices cuts between neighbouring frames: it keeps the last frame's layers without noise.
class CutFinder {
  public:
    explicit CutFinder(const ShotJob& job) : job_(job) {}

    /// True if the frame is no neighbour of that of the last call in the same shot.
    bool isCut(const LoadedFrame& frame) {
        const int before = number_;
        number_ = frame.number;
        if (job_.cuts == Cuts::Given) {
            const int later = std::max(before, number_);
            return std::find(job_.cutFrames.begin(), job_.cutFrames.end(), later) != job_.cutFrames.end();
        }
        if (frame.layers.empty()) return false;  // Limpid's files mark cuts in their motion
        shot::ShotLayers now = guidesOf(frame.layers.front());
        const shot::Encoding& encoding = frame.maps.front().encoding;
        const bool forwards = before < number_;
        const bool cut =
            last_ && (forwards ? shot::isCut(*last_, now, encoding) : shot::isCut(now, *last_, encoding));
        last_ = std::move(now);
        return cut;
    }

  private:
    static shot::ShotLayers guidesOf(const shot::ShotLayers& layers) {
        shot::ShotLayers guides;
        guides.width = layers.width;
        guides.height = layers.height;
        for (const char* role : {"albedo", "normal", "motion"})
            if (const image::Image* const image = layers.find(role)) guides.images[role] = *image;
        return guides;
    }

    const ShotJob& job_;
    std::optional<shot::ShotLayers> last_;
    int number_ = 0;
};

/// A clean picture in seven bytes per pixel.
struct PackedPicture {
    std::vector<uint16_t> colors, alpha;
    std::vector<uint8_t> frames;

    explicit PackedPicture(const CleanPicture& picture) {
        colors.reserve(picture.beauty.size() / 4 * 3);
        for (size_t i = 0; i < picture.beauty.size(); ++i)
            if (i % 4 != 3)
                colors.push_back(glm::packHalf1x16(std::clamp(picture.beauty[i], -65504.0f, 65504.0f)));
        for (const float share : picture.alpha) alpha.push_back(glm::packHalf1x16(share));
        for (const float count : picture.frames)
            frames.push_back(static_cast<uint8_t>(std::clamp(count, 0.0f, 255.0f)));
    }

    CleanPicture unpacked() const {
        CleanPicture picture;
        picture.beauty.resize(colors.size() / 3 * 4);
        for (size_t i = 0; i < colors.size(); ++i)
            picture.beauty[i / 3 * 4 + i % 3] = glm::unpackHalf1x16(colors[i]);
        for (const uint16_t share : alpha) picture.alpha.push_back(glm::unpackHalf1x16(share));
        picture.frames.assign(frames.begin(), frames.end());
        return picture;
    }
};

/// What is written of one frame.
struct FrameToWrite {
    uint64_t content = 0;  ///< LoadedFrame::content
    image::ExrDocument file;
    std::vector<shot::LayerMap> maps;
    std::vector<CleanPicture> pictures;
    std::vector<float> surfaces;
};

constexpr const char* inputAttribute = "limpid.input";

/// Changes with the content of a frame's files and with what is done to them.
std::string identityOf(uint64_t content, const ShotJob& job) {
    Hash64 hash;
    hash.addValue(content);
    hash.add(job.settingsText);
    return hashText(hash.value());
}

/// 1 where a surface is seen, for the exposure; empty if unknown.
std::vector<float> surfacesOf(const LoadedFrame& frame) {
    std::vector<float> result;
    if (frame.own) {
        for (size_t p = 0; p < frame.own->pixelCount(); ++p)
            result.push_back(frame.own->depth[4 * p + 1] > 0.0f ? 1.0f : 0.0f);
    } else if (const image::Image* const depth = frame.layers.front().find("depth")) {
        for (const float z : depth->pixels)
            result.push_back(z > 0.0f && z < frame.maps.front().encoding.farDepth ? 1.0f : 0.0f);
    }
    return result;
}

void mixWithInput(FrameToWrite& frame, float strength) {
    for (size_t i = 0; i < frame.pictures.size(); ++i) {
        const image::Image noisy = frame.maps[i].layers.at("beauty").evaluate(frame.file);
        std::vector<float>& beauty = frame.pictures[i].beauty;
        for (size_t p = 0; 4 * p < beauty.size(); ++p)
            for (size_t c = 0; c < 3; ++c) {
                const float input = noisy.pixels[3 * p + c];
                if (std::isfinite(input)) beauty[4 * p + c] = input + strength * (beauty[4 * p + c] - input);
            }
        std::vector<float>& alpha = frame.pictures[i].alpha;
        if (alpha.empty()) continue;
        const image::Image given = frame.maps[i].layers.at("alpha").evaluate(frame.file);
        for (size_t p = 0; p < alpha.size(); ++p)
            alpha[p] = given.pixels[p] + strength * (alpha[p] - given.pixels[p]);
    }
}

void writeFrame(const fs::path& path, FrameToWrite frame, const ShotJob& job) {
    if (job.strength < 1.0f) mixWithInput(frame, job.strength);
    if (!isExr(path)) {
        image::Image picture(frame.file.width(), frame.file.height(), 3);
        for (size_t i = 0; i < picture.pixels.size(); ++i)
            picture.pixels[i] = frame.pictures.front().beauty[i / 3 * 4 + i % 3];
        const float stops =
            parseExposure(job.exposure).value_or(image::autoExposure(picture, frame.surfaces));
        return image::writePng(path, image::toBytes(image::tonemap(picture, stops)));
    }
    std::set<size_t> parts;
    for (size_t i = 0; i < frame.pictures.size(); ++i) {
        shot::shareOut(frame.pictures[i]);
        parts.merge(shot::replacePicture(frame.file, frame.maps[i], frame.pictures[i]));
    }
    for (const size_t part : parts) {
        frame.file.setText(part, "limpid.denoiser", std::string(job.options.method->name));
        frame.file.setText(part, inputAttribute, identityOf(frame.content, job));
    }
    frame.file.write(path);
}

/// True if the output of this frame is complete: it says that it is of this input and these settings.
bool isComplete(int frame, const ShotJob& job) {
    const fs::path output = job.output.format(std::max(frame, 0));
    if (!fs::exists(output)) return false;
    try {
        const image::ExrDocument file = image::ExrDocument::read(output);
        const uint64_t content = shot::contentOf(job.input.format(std::max(frame, 0)), frame, job.load);
        const std::string identity = identityOf(content, job);
        return std::any_of(file.parts().begin(), file.parts().end(), [&](const image::ExrPart& part) {
            const auto text = part.texts.find(inputAttribute);
            return text != part.texts.end() && text->second == identity;
        });
    } catch (const InputError&) {
        return false;
    }
}

/// The index of the first frame whose output is not complete.
size_t firstIncomplete(const ShotJob& job) {
    size_t i = job.firstWritten;
    while (i < job.endWritten && isComplete(job.frames[i], job)) ++i;
    return i;
}

/// Writes frames, each while the next one is denoised.
class FrameWriter {
  public:
    explicit FrameWriter(const ShotJob& job) : job_(job) {}

    void write(int number, FrameToWrite frame) {
        finish();
        const fs::path path = job_.output.format(std::max(number, 0));
        writing_ = std::async(std::launch::async, [this, path, moved = std::move(frame)]() mutable {
            writeFrame(path, std::move(moved), job_);
        });
    }

    /// Throws what writing threw.
    void finish() {
        if (writing_.valid()) writing_.get();
    }

  private:
    const ShotJob& job_;
    std::future<void> writing_;
};

void warnOf(const LoadedFrame& frame, const ShotJob& job) {
    for (const LayerInfo* layer : frame.lacking)
        log::warn("the layer '{}' is missing: {}", layer->name, layer->without);
    for (const shot::LayerMap& map : frame.maps)
        for (const shot::RoleInfo& role : shot::roles())
            if (!frame.own && !map.find(role.name) && role.isImportant &&
                (job.load.sequence || role.name != "motion"))
                log::warn("the layer '{}' is missing: {}", role.name, shot::withoutRole(map, role));
}

class ShotRun {
  public:
    ShotRun(const ShotJob& job, gpu::Device& device)
        : job_(job),
          device_(device),
          reader_(job),
          denoiser_(device, job.options, shot::Direction::Forwards),
          cuts_(job),
          writer_(job),
          first_(job.resume ? firstIncomplete(job) : job.firstWritten),
          progress_("frames", job.endWritten - first_) {}

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
            if (i >= first_) progress_.show(i + 1 - first_);
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
        shot::ShotDenoiser denoiser(device_, job_.options, shot::Direction::Backwards);
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
        if (first) {
            warnOf(frame, job_);
            if (isExr(job_.output.format(0)))
                for (const shot::LayerMap& map : frame.maps) shot::checkReplaceable(frame.file, map);
        }
        if (cut && !first) summary_.cuts.push_back(frame.number);
        // Motion leads to the frame before, so after a gap it leads nowhere.
        const bool continues = !first && !cut && frame.number == *last_ + 1;
        last_ = frame.number;
        FrameToWrite result;
        if (!isExr(job_.output.format(0))) result.surfaces = surfacesOf(frame);
        result.pictures = denoiser_.denoise(frame, continues);
        if (!isWritten) return;
        ++summary_.frames;
        const auto later = backwards_.find(frame.number);
        for (size_t i = 0; i < result.pictures.size(); ++i) {
            const uint64_t rejected = result.pictures[i].disocclusion.rejected;
            if (rejected > 0)
                log::warn("{}: {} pixels are NaN or infinite and were left out", frame.file.name().string(),
                          rejected);
            if (later != backwards_.end() && i < later->second.size())
                shot::merge(result.pictures[i], later->second[i].unpacked());
        }
        summary_.lastFrame = sumByName(denoiser_.graph(0).passTimes(device_));
        if (!job_.dump.empty())
            writeDump(job_.output.format(std::max(frame.number, 0)),
                      imagesOfPass(denoiser_.graph(0), device_, job_.dump));
        result.content = frame.content;
        result.file = std::move(frame.file);
        result.maps = std::move(frame.maps);
        writer_.write(frame.number, std::move(result));
    }

    const ShotJob& job_;
    gpu::Device& device_;
    FrameReader reader_;
    shot::ShotDenoiser denoiser_;
    CutFinder cuts_;
    FrameWriter writer_;
    size_t first_;  ///< index of the first frame that is written
    Progress progress_;
    ShotSummary summary_;
    std::map<int, std::vector<PackedPicture>> backwards_;  ///< of the block, by frame and picture
    std::optional<int> last_;
};

}  // namespace

ShotSummary denoiseShot(const ShotJob& job, gpu::Device& device) {
    return ShotRun(job, device).run();
}

}  // namespace limpid::cli
