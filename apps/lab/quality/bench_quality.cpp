#include "lab/quality/bench_quality.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cli/cluster/session.h"
#include "cli/console/pass_times.h"
#include "image/io/png/png.h"
#include "image/metrics/flicker.h"
#include "image/metrics/metrics.h"
#include "image/tonemap.h"
#include "renderer/frame/frame_renderer.h"
#include "renderer/layers/layers.h"

namespace limpid::cli {
namespace {

using image::Image;

/// The halves differ by twice the RMS error of their mean. Values are compared as displayed.
double ownPsnr(const std::vector<Reference>& references, float stops) {
    double sum = 0.0;
    for (const Reference& reference : references) {
        Image a = reference.picture, b = reference.picture;
        for (size_t i = 0; i < a.pixels.size(); ++i) {
            a.pixels[i] -= 0.5f * reference.difference.pixels[i];
            b.pixels[i] += 0.5f * reference.difference.pixels[i];
        }
        sum += image::psnr(image::displayEncode(a, stops), image::displayEncode(b, stops)) +
               20.0 * std::log10(2.0);
    }
    return sum / static_cast<double>(references.size());
}

/// Adds as much noise as the reference has, then encodes for display. The reference's noise changes from
/// frame to frame; without it, a perfect test would seem to change less. Half the difference of the
/// reference's halves is as strong as the error of their mean, and independent of it.
Image shownWithNoiseOf(const Reference& reference, const Image& picture, const Image& shown, float stops) {
    Image noisy = picture;
    for (size_t i = 0; i < noisy.pixels.size(); ++i) noisy.pixels[i] += 0.5f * reference.difference.pixels[i];
    Image result = image::displayEncode(noisy, stops);
    for (size_t i = 0; i < noisy.pixels.size(); ++i) {
        if (!std::isfinite(noisy.pixels[i])) result.pixels[i] = shown.pixels[i];
    }
    return result;
}

std::vector<char> reportPng(const Image& encoded) {
    return image::encodePng(image::toBytes(encoded), "a picture of the report");
}

/// The references that frames are compared with.
struct Truth {
    const std::vector<Reference>& references;
    float exposure;     ///< stops
    bool keepPictures;  ///< for a report
};

/// Scores one frame after the other; flicker needs the previous frame.
class Judge {
  public:
    Judge(const Truth& truth, uint64_t first)
        : references_(truth.references),
          first_(first),
          stops_(truth.exposure),
          keepPictures_(truth.keepPictures) {}
    Judge(const Judge&) = delete;
    Judge& operator=(const Judge&) = delete;

    void add(MethodQuality& method, uint64_t frame, Image picture) {
        const Reference& reference = references_[frame - first_];
        image::Comparison c = image::compare(picture, reference.picture, stops_);
        image::FrameScores scores{.frame = static_cast<int>(frame),
                                  .psnr = c.psnr,
                                  .ssim = c.ssim,
                                  .relMse = c.relMse,
                                  .flip = c.flip};
        scores.invalidPixels = c.invalidPixels;
        if (keepPictures_) {
            method.pictures.push_back(reportPng(c.shownTest));
            method.errorMaps.push_back(reportPng(c.flipMap));
        }
        Shown shown{std::move(c.shownTest), {}, std::move(c.shownReference), {}};
        shown.noisyTest = shownWithNoiseOf(reference, picture, shown.test, stops_);
        shown.noisyReference = shownWithNoiseOf(reference, reference.picture, shown.reference, stops_);
        if (before_) scoreChange(scores, shown, frame);
        before_ = std::move(shown);
        method.scores.push_back(scores);
        method.last = std::move(picture);
    }

  private:
    struct Shown {
        Image test, noisyTest, reference, noisyReference;
    };

    void scoreChange(image::FrameScores& scores, const Shown& now, uint64_t frame) const {
        const Shown& before = *before_;
        const auto reprojection =
            image::reproject(references_[frame - first_].geometry, references_[frame - first_ - 1].geometry);
        scores.flicker =
            image::flicker(now.noisyTest, before.noisyTest, now.reference, before.reference, reprojection);
        scores.temporalError =
            image::temporalError(now.test, before.test, now.reference, before.reference, reprojection);
        // Subtract the error that a perfect test would have.
        const auto ofNoise = image::temporalError(now.noisyReference, before.noisyReference, now.reference,
                                                  before.reference, reprojection);
        if (scores.temporalError && ofNoise) *scores.temporalError -= *ofNoise;
    }

    const std::vector<Reference>& references_;
    uint64_t first_;
    float stops_;
    bool keepPictures_;
    std::optional<Shown> before_;
};

Image noisyOf(RenderedLayers layers) {
    layers.beauty.clear();
    return beautyOf(layers);
}

/// Runs a denoiser. If `noisy` is set, scores its input too and stores the result there.
MethodQuality measure(FrameRenderer& renderer, const Sequence& sequence, gpu::Extent extent,
                      const QualityFrames& frames, const Truth& truth, MethodQuality* noisy) {
    Judge judge(truth, frames.first);
    Judge noisyJudge(truth, frames.first);
    MethodQuality method;
    PassTimes times;
    for (uint64_t frame = 0; frame < frames.count; ++frame) {
        if (ranks()) ranks()->beat();
        renderer.render(sequence.moment(frame, extent));
        if (frame < frames.first) continue;
        times.add(sumByName(renderer.passTimes()));
        double denoisingMs = 0.0;
        for (const gpu::PassTime& pass : renderer.denoisingTimes()) denoisingMs += pass.milliseconds;
        method.denoisingMs.push_back(denoisingMs);
        const RenderedLayers layers = renderer.download();
        judge.add(method, frame, beautyOf(layers));
        if (noisy) noisyJudge.add(*noisy, frame, noisyOf(layers));
    }
    method.medianMs = times.medians();
    method.denoisingBytesPerPixel = static_cast<double>(renderer.denoisingBytes()) /
                                    (static_cast<double>(extent.width) * static_cast<double>(extent.height));
    return method;
}

}  // namespace

SequenceQuality measureQuality(gpu::Device& device, scene::GpuScene& scene, const Sequence& sequence,
                               const std::vector<QualityMethod>& methods, const QualityFrames& frames,
                               const std::vector<Reference>& references, uint32_t samples,
                               bool keepPictures) {
    SequenceQuality quality;
    std::vector<std::optional<float>> measured;
    for (const Reference& reference : references)
        measured.push_back(image::measuredExposure(reference.picture));
    if (methods.front().settings.pipeline.needsExposure())
        quality.exposure = image::sequenceExposure(measured);
    quality.referencePsnr = ownPsnr(references, quality.exposure);
    quality.reference = references.back().picture;
    for (const Reference& reference : references) {
        if (keepPictures)
            quality.referencePictures.push_back(
                reportPng(image::displayEncode(reference.picture, quality.exposure)));
    }
    quality.methods.emplace_back().name = "noisy";
    for (const QualityMethod& chosen : methods) {
        const bool first = quality.methods.size() == 1;
        RenderSettings settings = chosen.settings;
        settings.layers = first;  // the noisy picture is computed from them
        FrameRenderer renderer(device, scene, settings, samples);
        MethodQuality method =
            measure(renderer, sequence, settings.extent, frames, {references, quality.exposure, keepPictures},
                    first ? &quality.methods.front() : nullptr);
        method.name = chosen.name;
        quality.methods.push_back(std::move(method));
    }
    return quality;
}

}  // namespace limpid::cli
