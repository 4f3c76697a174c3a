#include "tests/oracle/double_visibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tests/oracle/double_reprojection.h"

namespace limpid::test {
namespace {

constexpr double youngFrames = 4.0, notFilled = -2.0, nothingSeen = -1.0;

double longest(const DoubleVisibilityParams& params) {
    return std::max(youngFrames, 1.0 / params.alpha);
}

/// A(a) for N frames, in the slow mean (twice: first and second moment) and in the fast one.
dvec3 sharesOf(double frames, const DoubleVisibilityParams& params) {
    return glm::max(dvec3(params.alpha, params.alpha, params.alphaFast), dvec3(1.0 / frames));
}

dvec3 powersOf(double x) {
    return {x, x * x, x};
}

std::vector<PreviousSurface> previousSurfaces(const VisibilityHistory& history, size_t count) {
    std::vector<PreviousSurface> result(count);
    for (size_t q = 0; q < history.moments.size(); ++q) {
        result[q] = {history.surfaces.normal[q], history.surfaces.distance[q], history.surfaces.id[q],
                     history.moments[q].w > 0.0};
    }
    return result;
}

void update(dvec4& moments, VisibilityPixel& pixel, double x, const DoubleVisibilityParams& params) {
    const double frames = std::min(moments.w + 1.0, longest(params));
    const dvec3 shares = sharesOf(frames, params), was(moments), is = powersOf(x);
    const dvec3 slope =
        dvec3(pixel.slope) * (1.0 - shares) + glm::abs(is - was) * pixel.slope.w / (frames * frames);
    moments = dvec4(was + (is - was) * shares, frames);
    pixel.slope = dvec4(slope, pixel.slope.w);
}

DoubleSvgfParams lagParams(const DoubleVisibilityParams& params) {
    return {.alpha = params.alpha,
            .alphaMoments = params.alpha,
            .alphaFast = params.alphaFast,
            .antilag = params.antilag,
            .antilagNoise = params.antilagNoise,
            .antilagPixel = 2.5,
            .antilagAround = true};
}

/// Reads lags bilinearly at a pixel's centre.
double lagAt(const std::vector<double>& lags, const denoise::HostFrame& frame, size_t p) {
    const dvec2 pixel(static_cast<double>(p % frame.width), static_cast<double>(p / frame.width));
    const dvec2 at = (pixel + 0.5) / 8.0 - 0.5, first = glm::floor(at), share = at - first;
    const auto columns = static_cast<int64_t>((frame.width + 7) / 8);
    const auto rows = static_cast<int64_t>((frame.height + 7) / 8);
    double lag = 0.0;
    for (int k = 0; k < 4; ++k) {
        const int64_t x = std::clamp<int64_t>(static_cast<int64_t>(first.x) + k % 2, 0, columns - 1);
        const int64_t y = std::clamp<int64_t>(static_cast<int64_t>(first.y) + k / 2, 0, rows - 1);
        const double weight = (k % 2 == 0 ? 1.0 - share.x : share.x) * (k / 2 == 0 ? 1.0 - share.y : share.y);
        lag += weight * lags[static_cast<size_t>(y * columns + x)];
    }
    return lag;
}

class Level {
  public:
    Level(const denoise::HostFrame& frame, const SvgfSurfaces& surfaces, const std::vector<dvec2>& signal,
          int i, const DoubleVisibilityParams& params)
        : frame_(frame), surfaces_(surfaces), signal_(signal), level_(i), params_(params) {}

    dvec2 at(size_t p) const {
        if (surfaces_.distance[p] <= 0.0) return signal_[p];
        const double v = signal_[p].x;
        const double tolerance = params_.phi * std::sqrt(guide(p)) + 0.001 * v + 1e-6;
        double sum = 0.0, squares = 0.0, weights = 0.0;
        around(p, int64_t{1} << level_, [&](size_t q, double spline, const dvec2& offset) {
            double w = spline;
            if (p != q) {
                w *= likeness(p, q, offset);
                if (signal_[p].y >= 0.0) w *= std::exp(-std::abs(v - signal_[q].x) / tolerance);
            }
            sum += w * signal_[q].x;
            squares += w * w * signal_[q].y * signal_[q].y;
            weights += w;
        });
        return weights > 0.0 ? dvec2(sum, std::sqrt(squares)) / weights : signal_[p];
    }

  private:
    /// Calls visit(q, spline weight, offset) for the 3x3 pixels that lie `step` apart, see something and have
    /// a value.
    template <typename Visit>
    void around(size_t p, int64_t step, const Visit& visit) const {
        constexpr std::array<double, 3> tent{0.25, 0.5, 0.25};
        const auto width = static_cast<int64_t>(frame_.width), height = static_cast<int64_t>(frame_.height);
        const int64_t x = static_cast<int64_t>(p) % width, y = static_cast<int64_t>(p) / width;
        for (int64_t j = -1; j <= 1; ++j) {
            for (int64_t i = -1; i <= 1; ++i) {
                const int64_t qx = x + step * i, qy = y + step * j;
                if (qx < 0 || qy < 0 || qx >= width || qy >= height) continue;
                const auto q = static_cast<size_t>(qy * width + qx);
                if (surfaces_.distance[q] <= 0.0 || signal_[q].y < 0.0) continue;
                visit(q, tent[static_cast<size_t>(i + 1)] * tent[static_cast<size_t>(j + 1)],
                      dvec2(step * i, step * j));
            }
        }
    }

    /// w_n w_z
    double likeness(size_t p, size_t q, const dvec2& offset) const {
        const double z = surfaces_.distance[p];
        const dvec2 slope = svgfSlope(frame_, p, surfaces_.normal[p], z);
        const double expected = std::abs(glm::dot(offset, slope)) + 0.001 * z;
        return std::exp(-params_.phiNormal * (1.0 - glm::dot(surfaces_.normal[p], surfaces_.normal[q])) -
                        std::abs(z - surfaces_.distance[q]) / (params_.phiDepth * expected));
    }

    double guide(size_t p) const {
        if (level_ > 0) return signal_[p].y * signal_[p].y;
        double sum = 0.0, weights = 0.0;
        around(p, 1, [&](size_t q, double w, const dvec2&) {
            sum += w * signal_[q].y * signal_[q].y;
            weights += w;
        });
        return weights > 0.0 ? sum / weights : 0.0;
    }

    const denoise::HostFrame& frame_;
    const SvgfSurfaces& surfaces_;
    const std::vector<dvec2>& signal_;
    int level_;
    const DoubleVisibilityParams& params_;
};

}  // namespace

std::optional<double> visibilitySample(const denoise::HostFrame& frame, size_t p) {
    const double light = double{frame.diffuse[4 * p]};
    if (!std::isfinite(light)) return std::nullopt;
    const double seen = frame.emission.empty() ? 0.0 : double{frame.emission[4 * p]};
    return std::clamp(light + (std::isfinite(seen) ? seen : 0.0), 0.0, 1.0);
}

VisibilityAccumulated visibilityAccumulate(const denoise::HostFrame& frame, const VisibilityHistory& previous,
                                           const DoubleVisibilityParams& params) {
    const VisibilityHistory none;
    const bool fits = previous.width == frame.width && previous.height == frame.height;
    const VisibilityHistory& past = fits ? previous : none;
    const DoubleFrame pixels(frame);
    const size_t count = frame.pixelCount();
    const std::vector<PreviousSurface> surfaces = previousSurfaces(past, count);
    const ReprojectionParams reprojection{params.normalTest, params.depthTest, true, true};
    const Reprojector reprojector(frame, surfaces, reprojection);
    VisibilityAccumulated result{std::vector<dvec4>(count, dvec4(0.0)), std::vector<VisibilityPixel>(count)};
    for (size_t p = 0; p < count; ++p) {
        VisibilityPixel& pixel = result.pixels[p];
        const std::optional<double> x = visibilitySample(frame, p);
        pixel.rejected = !x;
        if (!pixels.hit(p)) continue;
        Decision decision;
        const Reprojection found = reprojector.find(p, decision);
        pixel.doubtful = decision.doubtful();
        if (found.failure == 0) {
            const Resampled old = resample(found, [&](size_t q) { return past.moments[q]; });
            result.moments[p] = old.mean;
            pixel.slope = old.slope;
        }
        if (x) update(result.moments[p], pixel, *x, params);
    }
    return result;
}

SvgfTiles visibilityTiles(const denoise::HostFrame& frame, const std::vector<dvec4>& moments,
                          const DoubleVisibilityParams& params, const std::vector<dvec4>& errors) {
    return svgfTiles(frame, moments, lagParams(params), errors);
}

void visibilityShorten(const denoise::HostFrame& frame, const std::vector<double>& lags,
                       const DoubleVisibilityParams& params, VisibilityAccumulated& accumulated) {
    for (size_t p = 0; p < accumulated.moments.size(); ++p) {
        dvec4& moments = accumulated.moments[p];
        VisibilityPixel& pixel = accumulated.pixels[p];
        const double lag = lagAt(lags, frame, p);
        pixel.doubtful = pixel.doubtful || std::abs(lag - 0.1) < 1e-5;
        if (lag < 0.1 || pixel.rejected || moments.w <= 1.0) continue;
        const double frames = 1.0 + (moments.w - 1.0) * (1.0 - lag);
        const dvec3 had = sharesOf(moments.w, params), has = sharesOf(frames, params);
        const dvec3 more = (has - had) / glm::max(1.0 - had, 1e-6), was(moments);
        moments = dvec4(was + (powersOf(*visibilitySample(frame, p)) - was) * more, frames);
        // The shares of short histories change most with the frames.
        pixel.slope = dvec4(dvec3(pixel.slope) + pixel.slope.w / (frames * frames), pixel.slope.w);
    }
}

dvec2 visibilitySignal(const denoise::HostFrame& frame, size_t p, const dvec4& moments) {
    if (!DoubleFrame(frame).hit(p)) return {visibilitySample(frame, p).value_or(1.0), nothingSeen};
    if (moments.w <= 0.0) return {1.0, notFilled};
    const double deviation = moments.w < youngFrames ? 0.5 : svgfDeviation(moments.x, moments.y);
    return {moments.x, svgfBoost(moments.w, true) * deviation};
}

std::vector<bool> visibilityFillYoung(const denoise::HostFrame& frame, const SvgfSurfaces& surfaces,
                                      const std::vector<dvec2>& signal, const std::vector<dvec4>& moments,
                                      const DoubleVisibilityParams& params, std::vector<dvec2>& filtered) {
    // SVGF's formula for grey light.
    const DoubleSvgfParams filling{
        .youngRadius = params.youngRadius, .phiNormal = params.phiNormal, .phiDepth = params.phiDepth};
    std::vector<dvec4> light, result;
    for (const dvec2& v : signal) light.emplace_back(dvec3(v.x), v.y);
    for (const dvec2& v : filtered) result.emplace_back(dvec3(v.x), v.y);
    const std::vector<bool> doubtful =
        svgfFillYoung(frame, SvgfSignal::Joint, surfaces, light, moments, filling, result);
    for (size_t p = 0; p < filtered.size(); ++p) filtered[p] = {result[p].x, result[p].w};
    return doubtful;
}

std::vector<dvec2> visibilityLevel(const denoise::HostFrame& frame, const SvgfSurfaces& surfaces,
                                   const std::vector<dvec2>& signal, int i,
                                   const DoubleVisibilityParams& params) {
    const Level level(frame, surfaces, signal, i, params);
    std::vector<dvec2> result;
    for (size_t p = 0; p < frame.pixelCount(); ++p) result.push_back(level.at(p));
    return result;
}

}  // namespace limpid::test
