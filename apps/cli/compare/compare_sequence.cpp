// `limpid compare` for numbered pictures: every frame's scores, with one exposure, and flicker between
// frames.
#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "cli/compare/compare_report.h"
#include "cli/console/progress.h"
#include "cli/options/compare_options.h"
#include "image/colormap.h"
#include "image/io/picture.h"
#include "image/metrics/flicker.h"
#include "image/metrics/frame_scores.h"
#include "image/metrics/metrics.h"
#include "image/tonemap.h"

namespace limpid::cli {
namespace {

using image::FrameScores;
using image::MotionSource;
using image::SequencePicture;

/// Returns the frames to compare. Throws InputError unless test and reference (if it is a sequence) have the
/// same frames.
std::vector<int> matchingFrames(const CompareOptions& options) {
    const std::vector<int> frames = options.test.wholeSequence();
    if (!options.reference.numbered()) return frames;
    const std::vector<int> reference = options.reference.wholeSequence();
    if (frames == reference) return frames;
    throw InputError(options.test.text(),
                     fmt::format("its frames are {}, but those of {} are {}", describeFrames(frames),
                                 options.reference.text(), describeFrames(reference)));
}

/// The reference of each frame: read on demand, or one picture for all frames.
class References {
  public:
    explicit References(const FramePattern& pattern) : pattern_(pattern) {}

    /// The result is valid until the next call.
    const SequencePicture& at(int frame) {
        if (!current_ || pattern_.numbered()) {
            current_ = image::readSequencePicture(pattern_.format(frame));
            checkReferenceFinite(pattern_.format(frame), current_->picture.linear);
        }
        return *current_;
    }
    const FramePattern& pattern() const { return pattern_; }

  private:
    const FramePattern& pattern_;
    std::optional<SequencePicture> current_;
};

/// Chooses one exposure for all frames. Reads every reference if it must measure.
float chooseStops(const CompareOptions& options, References& references, const std::vector<int>& frames) {
    if (options.stops) return *options.stops;
    if (!options.autoExposure && !references.at(frames.front()).picture.sceneReferred) return 0.0f;
    std::vector<std::optional<float>> measured;
    for (const int frame : frames) {
        measured.push_back(image::measuredExposure(references.at(frame).picture.linear));
        if (!references.pattern().numbered()) break;
    }
    return image::sequenceExposure(measured);
}

/// The data of the previous frame that the flicker metric needs.
struct PreviousFrame {
    image::Image shownTest, shownReference;
    image::Geometry test, reference;
};

image::Reprojection reprojectionOf(MotionSource motion, const PreviousFrame& before,
                                   const SequencePicture& test, const SequencePicture& reference) {
    switch (motion) {
        case MotionSource::Reference:
            return image::reproject(reference.geometry, before.reference);
        case MotionSource::Test:
            return image::reproject(test.geometry, before.test);
        case MotionSource::None:
            break;
    }
    return image::stillReprojection(test.picture.linear.width, test.picture.linear.height);
}

class SequenceComparison {
  public:
    SequenceComparison(const CompareOptions& options, float stops, References& references)
        : options_(options), stops_(stops), references_(references) {}

    FrameScores compare(int frame) {
        SequencePicture test = image::readSequencePicture(options_.test.format(frame));
        const SequencePicture& reference = references_.at(frame);
        checkSizes(frame, test.picture.linear, reference.picture.linear);
        image::Comparison c = image::compare(test.picture.linear, reference.picture.linear, stops_);
        FrameScores scores{
            .frame = frame, .psnr = c.psnr, .ssim = c.ssim, .relMse = c.relMse, .flip = c.flip};
        scores.invalidPixels = c.invalidPixels;
        if (options_.errorMap) image::writeErrorMap(options_.errorMap->format(frame), c.flipMap);
        addHdrFlip(scores, test.picture, reference.picture);
        if (before_) addFlicker(scores, test, reference, c);
        before_ = PreviousFrame{std::move(c.shownTest), std::move(c.shownReference), std::move(test.geometry),
                                reference.geometry};
        return scores;
    }

    SequenceFacts facts() const { return {width_, height_, stops_}; }

  private:
    void checkSizes(int frame, const image::Image& test, const image::Image& reference) {
        const std::filesystem::path file = options_.test.format(frame);
        checkSameSize(file, test, options_.reference.format(frame), reference);
        if (before_ && (test.width != width_ || test.height != height_)) {
            throw InputError(file, fmt::format("is {}x{} pixels, but the frames before are {}x{}", test.width,
                                               test.height, width_, height_));
        }
        width_ = test.width;
        height_ = test.height;
    }

    void addHdrFlip(FrameScores& scores, const image::Picture& test, const image::Picture& reference) const {
        if (!haveHdrFlip(options_, options_.test.format(scores.frame), test,
                         options_.reference.format(scores.frame), reference)) {
            return;
        }
        const image::HdrFlip hdr = image::hdrFlip(test.linear, reference.linear);
        scores.hdrFlip = hdr.value;
        scores.hdrExposures = hdr.exposures;
        if (options_.hdrErrorMap) image::writeErrorMap(options_.hdrErrorMap->format(scores.frame), hdr.map);
    }

    /// A single reference picture means that nothing moves in the scene.
    MotionSource motionOf(const SequencePicture& test, const SequencePicture& reference) const {
        if (!options_.reference.numbered()) return MotionSource::None;
        if (reference.geometry.motion) return MotionSource::Reference;
        return test.geometry.motion ? MotionSource::Test : MotionSource::None;
    }

    void addFlicker(FrameScores& scores, const SequencePicture& test, const SequencePicture& reference,
                    const image::Comparison& c) const {
        scores.motion = motionOf(test, reference);
        const image::Reprojection reprojection = reprojectionOf(*scores.motion, *before_, test, reference);
        scores.flicker = image::flicker(c.shownTest, before_->shownTest, c.shownReference,
                                        before_->shownReference, reprojection);
        scores.temporalError = image::temporalError(c.shownTest, before_->shownTest, c.shownReference,
                                                    before_->shownReference, reprojection);
        scores.flickerPixels =
            static_cast<double>(reprojection.used) / static_cast<double>(reprojection.sources.size());
    }

    const CompareOptions& options_;
    float stops_;
    References& references_;
    std::optional<PreviousFrame> before_;
    uint32_t width_ = 0, height_ = 0;
};

void warnOfInvalidPixels(const CompareOptions& options, const std::vector<FrameScores>& scores) {
    uint64_t pixels = 0;
    std::vector<int> frames;
    for (const FrameScores& frame : scores) {
        pixels += frame.invalidPixels;
        if (frame.invalidPixels > 0) frames.push_back(frame.frame);
    }
    if (pixels == 0) return;
    log::warn("{}: {} pixels are NaN or infinite (frames {}); they count as the worst error",
              options.test.text(), pixels, describeFrames(frames));
}

}  // namespace

void compareSequence(const CompareOptions& options) {
    const std::vector<int> frames = matchingFrames(options);
    References references(options.reference);
    SequenceComparison comparison(options, chooseStops(options, references, frames), references);
    std::vector<FrameScores> scores;
    {
        Progress progress("frames", frames.size());
        for (const int frame : frames) {
            progress.show(scores.size());
            scores.push_back(comparison.compare(frame));
        }
    }
    warnOfInvalidPixels(options, scores);
    const SequenceFacts facts = comparison.facts();
    fmt::print("{}", options.json ? sequenceJson(scores, facts) : sequenceTable(scores, facts));
}

}  // namespace limpid::cli
