#include "tests/oracle/double_temporal.h"

#include <algorithm>
#include <cmath>

#include "tests/oracle/double_reprojection.h"

namespace limpid::test {
namespace {

/// A pixel's history before the new sample is added.
struct Old {
    int failure;
    dvec4 colour{0.0}, slope{0.0};
};

class Tracker {
  public:
    Tracker(const denoise::HostFrame& frame, const TemporalImages& previous,
            const DoubleTemporalParams& params)
        : frame_(frame),
          previous_(previous),
          params_(params),
          surfaces_(surfacesOf(previous)),
          reprojection_{params.normal, params.depth, params.relative, params.search, params.identity},
          reprojector_(frame, surfaces_, reprojection_) {}
    Tracker(const Tracker&) = delete;
    Tracker& operator=(const Tracker&) = delete;

    void track(size_t p, TemporalResult& result) const;

  private:
    static std::vector<PreviousSurface> surfacesOf(const TemporalImages& images);
    Old find(size_t p, Decision& decision) const;
    double countAfter(double count) const;

    DoubleFrame frame_;
    const TemporalImages& previous_;
    const DoubleTemporalParams& params_;
    std::vector<PreviousSurface> surfaces_;
    ReprojectionParams reprojection_;
    Reprojector reprojector_;
};

std::vector<PreviousSurface> Tracker::surfacesOf(const TemporalImages& images) {
    std::vector<PreviousSurface> surfaces;
    for (size_t q = 0; q < images.colour.size(); ++q) {
        surfaces.push_back({dvec3(images.normalDepth[q]), images.normalDepth[q].w, images.albedoId[q].w,
                            images.colour[q].w > 0.0});
    }
    return surfaces;
}

Old Tracker::find(size_t p, Decision& decision) const {
    const Reprojection found = reprojector_.find(p, decision);
    const dvec3 now = modulation(frame_.albedo(p), params_.minAlbedo);
    const Resampled old = resample(found, [&](size_t q) {
        const dvec4& value = previous_.colour[q];
        return dvec4(dvec3(value) * now / modulation(dvec3(previous_.albedoId[q]), params_.minAlbedo),
                     value.w);
    });
    return {found.failure, old.mean, old.slope};
}

double Tracker::countAfter(double count) const {
    return params_.maxHistory == 0 ? count + 1.0 : std::min<double>(count + 1.0, params_.maxHistory);
}

void Tracker::track(size_t p, TemporalResult& result) const {
    Decision decision;
    const Old old = find(p, decision);
    const dvec3 c = frame_.scattered(p);
    TemporalPixel& pixel = result.pixels[p];
    pixel = {old.failure, !isFiniteInFloat(c), decision.doubtful(), old.slope};
    dvec4& colour = result.images.colour[p];
    if (pixel.rejected) {
        colour = old.colour;  // zeros if no history was found
    } else {
        const bool grey = params_.greyRestart && old.failure >= (params_.greyMisses ? 1 : 2);
        const dvec4 before = grey ? dvec4(dvec3(params_.grey), 1.0) : old.colour;
        const double count = countAfter(before.w);
        const dvec3 step = c - dvec3(before);
        colour = dvec4(dvec3(before) + step / count, count);
        pixel.slope =
            dvec4(dvec3(old.slope) * (1.0 - 1.0 / count) + glm::abs(step) * old.slope.w / (count * count),
                  old.slope.w);
    }
    result.images.normalDepth[p] = dvec4(frame_.normal(p), frame_.distance(p));
    result.images.albedoId[p] = dvec4(frame_.albedo(p), frame_.id(p));
}

TemporalImages blankImages(uint32_t width, uint32_t height) {
    const std::vector<dvec4> zeros(size_t{width} * height, dvec4(0.0));
    return {width, height, zeros, zeros, zeros};
}

}  // namespace

TemporalResult accumulateTemporally(const denoise::HostFrame& frame, const TemporalImages& previous,
                                    const DoubleTemporalParams& params) {
    const TemporalImages blank = blankImages(frame.width, frame.height);
    const bool fits = previous.width == frame.width && previous.height == frame.height;
    const Tracker tracker(frame, fits ? previous : blank, params);
    TemporalResult result{blank, std::vector<TemporalPixel>(frame.pixelCount())};
    for (size_t p = 0; p < frame.pixelCount(); ++p) tracker.track(p, result);
    return result;
}

}  // namespace limpid::test
