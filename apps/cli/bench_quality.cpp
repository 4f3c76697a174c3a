#include "bench_quality.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bench.h"
#include "image/flicker.h"
#include "image/metrics.h"
#include "image/tonemap.h"
#include "progress.h"
#include "renderer/frame_renderer.h"
#include "renderer/layers.h"
#include "renderer/still.h"

namespace limpid::cli {
namespace {

using image::Image;

struct Reference {
    Image picture;
    image::Geometry geometry;
    Image difference;  ///< of the two halves
};

Image rendered(ProgressiveStill& still, Moment moment, const RenderSettings& settings,
               image::Geometry* geometry) {
    still.update(std::move(moment), settings);
    while (still.launch()) continue;
    const RenderedLayers layers = still.download();
    if (geometry)
        *geometry =
            image::geometryOf(toLayeredImage(layers, {"motion", "depth", "normal"}, image::Storage::Float));
    return beautyOf(layers);
}

/// Two halves of independent samples: their mean is the reference, their difference tells its error.
class ReferenceRenderer {
  public:
    ReferenceRenderer(gpu::Device& device, scene::GpuScene& scene, RenderSettings settings, uint64_t samples)
        : first_(device, scene, samples / 2),
          second_(device, scene, samples - samples / 2),
          settings_(settings) {
        settings_.pipeline = {};
        settings_.samplesPerLaunch = 64;
        settings_.layers = true;
    }

    Reference render(const Sequence& sequence, uint64_t frame) {
        Reference reference;
        settings_.seed = 1;  // its noise must not be the noise of what it judges
        reference.picture =
            rendered(first_, sequence.moment(frame, settings_.extent), settings_, &reference.geometry);
        settings_.seed = 2;
        const Image other = rendered(second_, sequence.moment(frame, settings_.extent), settings_, nullptr);
        reference.difference = other;
        for (size_t i = 0; i < other.pixels.size(); ++i) {
            reference.difference.pixels[i] -= reference.picture.pixels[i];
            reference.picture.pixels[i] = 0.5f * (reference.picture.pixels[i] + other.pixels[i]);
        }
        return reference;
    }

  private:
    ProgressiveStill first_, second_;
    RenderSettings settings_;
};

/// The halves differ by twice the error of their mean (RMS), as far as a screen shows it.
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

/// Scores frame after frame; flicker needs the frame before.
class Judge {
  public:
    Judge(const std::vector<Reference>& references, uint64_t first, float stops)
        : references_(references), first_(first), stops_(stops) {}

    void add(MethodQuality& method, uint64_t frame, Image picture) {
        const Reference& reference = references_[frame - first_];
        image::Comparison c = image::compare(picture, reference.picture, stops_);
        image::FrameScores scores{.frame = static_cast<int>(frame),
                                  .psnr = c.psnr,
                                  .ssim = c.ssim,
                                  .relMse = c.relMse,
                                  .flip = c.flip};
        scores.invalidPixels = c.invalidPixels;
        if (before_) {
            const auto reprojection =
                image::reproject(reference.geometry, references_[frame - first_ - 1].geometry);
            scores.flicker = image::flicker(c.shownTest, before_->shownTest, c.shownReference,
                                            before_->shownReference, reprojection);
        }
        before_ = std::move(c);
        method.scores.push_back(scores);
        method.last = std::move(picture);
    }

  private:
    const std::vector<Reference>& references_;
    uint64_t first_;
    float stops_;
    std::optional<image::Comparison> before_;
};

Image noisyOf(RenderedLayers layers) {
    layers.beauty.clear();
    return beautyOf(layers);
}

/// Runs a pipeline; with `noisyJudge`, its input is scored too.
MethodQuality measure(FrameRenderer& renderer, const Sequence& sequence, gpu::Extent extent,
                      const QualityFrames& frames, Judge judge, std::optional<Judge> noisyJudge,
                      MethodQuality& noisy) {
    MethodQuality method;
    PassTimes times;
    for (uint64_t frame = 0; frame < frames.count; ++frame) {
        renderer.render(sequence.moment(frame, extent));
        if (frame < frames.first) continue;
        times.add(sumByName(renderer.passTimes()));
        const RenderedLayers layers = renderer.download();
        judge.add(method, frame, beautyOf(layers));
        if (noisyJudge) noisyJudge->add(noisy, frame, noisyOf(layers));
    }
    method.medianMs = times.medians();
    return method;
}

}  // namespace

SequenceQuality measureQuality(gpu::Device& device, scene::GpuScene& scene, const Sequence& sequence,
                               const std::vector<QualityMethod>& methods, const QualityFrames& frames,
                               uint64_t referenceSamples, uint32_t samples) {
    std::vector<Reference> references;
    {
        ReferenceRenderer renderer(device, scene, methods.front().settings, referenceSamples);
        Progress progress("references", frames.count - frames.first);
        for (uint64_t frame = frames.first; frame < frames.count; ++frame) {
            references.push_back(renderer.render(sequence, frame));
            progress.show(references.size());
        }
    }
    SequenceQuality quality;
    std::vector<std::optional<float>> measured;
    for (const Reference& reference : references)
        measured.push_back(image::measuredExposure(reference.picture));
    quality.exposure = image::sequenceExposure(measured);
    quality.referencePsnr = ownPsnr(references, quality.exposure);
    quality.reference = references.back().picture;
    quality.methods.push_back({.name = "noisy", .scores = {}, .last = {}, .medianMs = {}});
    for (const QualityMethod& chosen : methods) {
        FrameRenderer renderer(device, scene, chosen.settings, samples);
        const Judge judge(references, frames.first, quality.exposure);
        const bool first = quality.methods.size() == 1;
        MethodQuality method = measure(renderer, sequence, chosen.settings.extent, frames, judge,
                                       first ? std::optional(judge) : std::nullopt, quality.methods.front());
        method.name = chosen.name;
        quality.methods.push_back(std::move(method));
    }
    return quality;
}

}  // namespace limpid::cli
