// Steps 5 and 6 of SVGF: the filters over a pixel's neighbours.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tests/oracle/svgf/double_svgf.h"

namespace limpid::test {
namespace {

constexpr double minCosine = 0.05;  // limits the slope of surfaces seen at grazing angles
constexpr double youngFrames = 4.0;
/// With less in sum, neighbours show other surfaces.
constexpr double leastWeights = 1e-3;
/// The number of neighbours that must be alike to judge a firefly by.
constexpr double leastAlike = 1.5;
constexpr double largestHalf = 65504.0;
/// Smaller sums of weights may underflow in float32.
constexpr double minWeights = 1e-30;

/// Access to pixels by coordinates, and the weights of neighbours from their surfaces.
class Neighbours {
  public:
    Neighbours(const denoise::HostFrame& frame, SvgfSignal signal, const SvgfSurfaces& surfaces,
               const DoubleSvgfParams& params)
        : width_(frame.width),
          height_(frame.height),
          surfaces_(surfaces),
          params_(params),
          comparesRoughness_(signal == SvgfSignal::Specular && params.phiRoughness > 0.0) {
        const DoubleFrame pixels(frame);
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            const double z = surfaces.distance[p];
            slopes_.push_back(z > 0.0 ? svgfSlope(frame, p, surfaces.normal[p], z) : dvec2(0.0));
            const dvec3 v = pixels.ray(p);
            const CameraParams& camera = frame.camera;
            const dvec3 across = v - dvec3(camera.forward);
            points_.push_back(camera.orthographic != 0 ? across + z * dvec3(camera.forward)
                                                       : z * v / glm::length(v));
        }
    }

    bool sees(size_t p) const { return surfaces_.distance[p] > 0.0; }

    /// Calls visit(q, i, j) for the pixels q = p + step (i, j), with i and j from -radius to radius, that are
    /// in the picture and have a hit.
    template <typename Visit>
    void around(size_t p, int64_t step, int radius, const Visit& visit) const {
        const auto x = static_cast<int64_t>(p) % width_, y = static_cast<int64_t>(p) / width_;
        for (int j = -radius; j <= radius; ++j) {
            for (int i = -radius; i <= radius; ++i) {
                const int64_t qx = x + step * i, qy = y + step * j;
                if (qx < 0 || qy < 0 || qx >= width_ || qy >= height_) continue;
                const auto q = static_cast<size_t>(qy * width_ + qx);
                if (sees(q)) visit(q, i, j);
            }
        }
    }

    /// Returns the weight w_n w_z (normals and distances) of a neighbour `offset` pixels away.
    double weight(size_t p, size_t q, const dvec2& offset) const {
        if (p == q) return 1.0;
        const dvec3 &n = surfaces_.normal[p], &other = surfaces_.normal[q];
        if (params_.position) {
            return std::exp(-glm::distance(n, other) / params_.phiNormal -
                            glm::distance(points_[p], points_[q]) / params_.phiDepth);
        }
        const double z = surfaces_.distance[p];
        const double expected = std::abs(glm::dot(offset, slopes_[p])) + 0.001 * z;
        double gloss = 0.0;
        if (comparesRoughness_)
            gloss = std::abs(surfaces_.roughness[p] - surfaces_.roughness[q]) / params_.phiRoughness;
        return std::exp(-params_.phiNormal * (1.0 - glm::dot(n, other)) - gloss -
                        std::abs(z - surfaces_.distance[q]) / (params_.phiDepth * expected));
    }

  private:
    int64_t width_, height_;
    const SvgfSurfaces& surfaces_;
    const DoubleSvgfParams& params_;
    bool comparesRoughness_;
    std::vector<dvec2> slopes_;
    std::vector<dvec3> points_;  ///< X
};

class Level {
  public:
    Level(const denoise::HostFrame& frame, SvgfSignal signal, const SvgfSurfaces& surfaces,
          const std::vector<dvec4>& color, uint32_t i, const DoubleSvgfParams& params)
        : neighbours_(frame, signal, surfaces, params),
          color_(color),
          level_(i),
          step_(int64_t{1} << i),
          params_(params) {
        for (const dvec4& c : color) luminances_.push_back(luminance(dvec3(c)));
    }

    dvec4 at(size_t p) const {
        constexpr std::array<double, 5> b3{1.0 / 16, 4.0 / 16, 6.0 / 16, 4.0 / 16, 1.0 / 16};
        constexpr std::array<double, 5> tent{0.0, 1.0 / 4, 2.0 / 4, 1.0 / 4, 0.0};
        const std::array<double, 5>& spline = params_.wide ? b3 : tent;
        if (!neighbours_.sees(p)) return color_[p];
        const double l = luminances_[p];
        const double own = tolerance(l, std::sqrt(guide(p)));
        const double compared = level_ < params_.meanLevels ? meanLuminance(p, own) : l;
        dvec3 sum(0.0);
        double variance = 0.0, weights = 0.0, squares = 0.0;
        neighbours_.around(p, step_, 2, [&](size_t q, int i, int j) {
            if (p == q) return;
            const double w = spline[static_cast<size_t>(i + 2)] * spline[static_cast<size_t>(j + 2)] *
                             likeness(p, q, dvec2(i, j), compared, own);
            sum += w * dvec3(color_[q]);
            variance += w * w * color_[q].w * color_[q].w;
            squares += w * color_[q].w * color_[q].w;
            weights += w;
        });
        const double w = spline[2] * spline[2] * ownShare(p, squares, weights);
        sum += w * dvec3(color_[p]);
        variance += w * w * color_[p].w * color_[p].w;
        weights += w;
        return {sum / weights, std::sqrt(variance) / weights};
    }

  private:
    /// Returns the weight of q = p + step (i, j) by its surface, and by its difference from `luminance`.
    double likeness(size_t p, size_t q, const dvec2& taps, double luminance, double own) const {
        return neighbours_.weight(p, q, static_cast<double>(step_) * taps) *
               std::exp(-std::abs(luminance - luminances_[q]) / own);
    }

    /// Returns lambda, the mean luminance of the taps that are like p.
    double meanLuminance(size_t p, double own) const {
        double sum = 0.0, weights = 0.0;
        neighbours_.around(p, step_, params_.wide ? 2 : 1, [&](size_t q, int i, int j) {
            const double w = likeness(p, q, dvec2(i, j), luminances_[p], own);
            sum += w * luminances_[q];
            weights += w;
        });
        return sum / weights;
    }

    /// Returns the share of its weight that p keeps. The sums are over the other pixels, of weighted squared
    /// deviations and of weights.
    double ownShare(size_t p, double squares, double weights) const {
        const double square = color_[p].w * color_[p].w;
        if (!params_.dampOutliers || level_ == 0 || square == 0.0) return 1.0;
        const double ofTaps = (squares + leastWeights * square) / (weights + leastWeights);
        return std::min(std::sqrt(ofTaps / square), 1.0);
    }

    double tolerance(double luminance, double deviation) const {
        return params_.phiColor * deviation + 0.001 * std::abs(luminance) + 1e-6;
    }

    /// Returns g, the blurred variance that sets the tolerance for luminance.
    double guide(size_t p) const {
        if (level_ >= params_.blurLevels) return color_[p].w * color_[p].w;
        double sum = 0.0, weights = 0.0;
        neighbours_.around(p, 1, 1, [&](size_t q, int i, int j) {
            const double w = (i == 0 ? 2.0 : 1.0) * (j == 0 ? 2.0 : 1.0);
            sum += w * color_[q].w * color_[q].w;
            weights += w;
        });
        return sum / weights;
    }

    Neighbours neighbours_;
    const std::vector<dvec4>& color_;
    int level_;
    int64_t step_;
    const DoubleSvgfParams& params_;
    std::vector<double> luminances_;
};

/// The standard deviation sigma, and a bound of float32's error of its square.
struct Deviation {
    double sigma, error;
};

/// Returns the deviation of the light of the neighbours of p that have a history: of all together, or with
/// `sampled` the mean of their own.
Deviation deviationAround(const Neighbours& neighbours, size_t p, const std::vector<dvec4>& moments,
                          bool sampled) {
    dvec2 sum(0.0);
    double weights = 0.0;
    bool found = false;
    neighbours.around(p, 1, 3, [&](size_t q, int i, int j) {
        if (moments[q].w <= 0.0) return;
        const double w = neighbours.weight(p, q, dvec2(i, j));
        const double variance = std::max(moments[q].y - moments[q].x * moments[q].x, 0.0);
        sum += w * (sampled ? dvec2(0.0, variance) : dvec2(moments[q]));
        weights += w;
        found = true;
    });
    if (!found) return {0.0, 0.0};
    if (weights < minWeights) return {0.0, std::numeric_limits<double>::infinity()};
    const dvec2 mean = sum / weights;
    // One rounding per neighbour. Without the centre, whose weight is 1, all weights may be small, and then
    // the rounding of their exponents matters too.
    const double rounding = 49 * 0x1p-24 + 2e-6 * std::max(-std::log(weights), 0.0);
    return {svgfDeviation(mean.x, mean.y), rounding * mean.y};
}

/// Within this share of a bound, float32 may find the value on its other side.
constexpr double doubt = 1e-3;

bool isCloseToLeast(double weights) {
    return std::abs(weights / leastWeights - 1.0) < doubt;
}

/// Mean and variance of the neighbours' m1.
struct Around {
    double mean = 0.0, variance = 0.0, weights = 0.0;
    double alike = 0.0;  ///< how many equal weights these amount to
    double error = 0.0;  ///< bounds float32's error of the variance

    /// Whether enough neighbours are alike to dim by them, with bounds that are higher by this share.
    bool tell(double higher = 0.0) const {
        return weights >= leastWeights * (1.0 + higher) && alike >= leastAlike * (1.0 + higher);
    }
};

Around meansAround(const Neighbours& neighbours, size_t p, const std::vector<dvec4>& moments) {
    Around result;
    double squares = 0.0, squaredWeights = 0.0;
    neighbours.around(p, 1, 1, [&](size_t q, int i, int j) {
        if (p == q || moments[q].w <= 0.0) return;
        const double w = neighbours.weight(p, q, dvec2(i, j));
        result.weights += w;
        squaredWeights += w * w;
        result.mean += w * moments[q].x;
        squares += w * moments[q].x * moments[q].x;
    });
    if (result.weights <= 0.0) return result;
    result.alike = result.weights * result.weights / squaredWeights;
    result.mean /= result.weights;
    squares /= result.weights;
    result.variance = std::max(squares - result.mean * result.mean, 0.0);
    result.error = (16 * 0x1p-24 + 2e-6 * std::max(-std::log(result.weights), 0.0)) * squares;
    return result;
}

}  // namespace

SvgfDimming svgfDimming(const denoise::HostFrame& frame, SvgfSignal signal, const SvgfSurfaces& surfaces,
                        const std::vector<dvec4>& color, const std::vector<dvec4>& moments,
                        const DoubleSvgfParams& params) {
    const Neighbours neighbours(frame, signal, surfaces, params);
    const std::vector<double> ones(frame.pixelCount(), 1.0);
    SvgfDimming result{ones, ones, ones};
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        const double n = moments[p].w, l = luminance(dvec3(color[p]));
        if (params.fireflies <= 0.0 || !neighbours.sees(p) || n >= youngFrames) continue;
        const Around around = meansAround(neighbours, p, moments);
        const auto factor = [&](double variance) {
            const double usual = around.mean + params.fireflies * n * n * std::sqrt(std::max(variance, 0.0)) +
                                 0.001 * std::abs(around.mean);
            const double limit = std::max(std::max(usual, 0.0) + 1e-6, l - params.phiColor * color[p].w);
            return l > limit ? limit / l : 1.0;
        };
        if (!around.tell(-doubt)) continue;
        if (around.tell()) result.factor[p] = factor(around.variance);
        result.least[p] = factor(around.variance - around.error);
        result.most[p] = around.tell(doubt) ? factor(around.variance + around.error) : 1.0;
    }
    return result;
}

std::vector<bool> svgfFillYoung(const denoise::HostFrame& frame, SvgfSignal signal,
                                const SvgfSurfaces& surfaces, const std::vector<dvec4>& color,
                                const std::vector<dvec4>& moments, const DoubleSvgfParams& params,
                                std::vector<dvec4>& filtered) {
    const Neighbours neighbours(frame, signal, surfaces, params);
    std::vector<bool> doubtful(frame.pixelCount());
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        const double n = svgfSamples(frame) * moments[p].w;
        if (params.youngRadius <= 0 || !neighbours.sees(p)) continue;
        if (moments[p].w >= youngFrames || n > youngFrames) continue;
        int radius = params.youngRadius;
        while (radius * radius * std::max(n, 1.0) > params.youngRadius * params.youngRadius) --radius;
        dvec3 sum(0.0);
        double variance = 0.0, weights = 0.0;
        neighbours.around(p, 1, radius, [&](size_t q, int i, int j) {
            const double w = (radius + 1 - std::abs(i)) * (radius + 1 - std::abs(j)) * moments[q].w *
                             neighbours.weight(p, q, dvec2(i, j));
            sum += w * dvec3(color[q]);
            variance += w * w * color[q].w * color[q].w;
            weights += w;
        });
        doubtful[p] = isCloseToLeast(weights);
        if (weights >= leastWeights) filtered[p] = {sum / weights, std::sqrt(variance) / weights};
    }
    return doubtful;
}

dvec2 svgfSlope(const denoise::HostFrame& frame, size_t p, const dvec3& normal, double distance) {
    const CameraParams& camera = frame.camera;
    const bool orthographic = camera.orthographic != 0;
    const dvec3 toRight = 2.0 * dvec3(camera.right) / static_cast<double>(frame.width);
    const dvec3 toBelow = -2.0 * dvec3(camera.up) / static_cast<double>(frame.height);
    const dvec3 v = orthographic ? dvec3(camera.forward) : DoubleFrame(frame).ray(p);
    double t = glm::dot(normal, v);
    const double least = minCosine * glm::length(v);
    if (std::abs(t) < least) t = t < 0.0 ? -least : least;
    const auto along = [&](const dvec3& pixel) {
        const double turned = -glm::dot(normal, pixel) / t;
        return orthographic ? turned : distance * (glm::dot(v, pixel) / glm::dot(v, v) + turned);
    };
    return {along(toRight), along(toBelow)};
}

SvgfVariance svgfYoungVariance(const denoise::HostFrame& frame, SvgfSignal signal,
                               const SvgfSurfaces& surfaces, const std::vector<dvec4>& color,
                               const std::vector<dvec4>& moments, const DoubleSvgfParams& params) {
    const Neighbours neighbours(frame, signal, surfaces, params);
    SvgfVariance result{color, std::vector<double>(frame.pixelCount(), 0.0)};
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        const double n = moments[p].w;
        if (!neighbours.sees(p) || n >= youngFrames) continue;
        const bool sampled = svgfSamples(frame) > 1.0;
        const Deviation around = deviationAround(neighbours, p, moments, sampled);
        const double boost = sampled ? 0.75 / std::sqrt(std::max(n, 1.0)) : svgfBoost(n, params.boost);
        result.color[p].w = std::min(boost * around.sigma, largestHalf);
        result.error[p] = boost * boost * around.error;
    }
    return result;
}

std::vector<dvec4> svgfLevel(const denoise::HostFrame& frame, SvgfSignal signal, const SvgfSurfaces& surfaces,
                             const std::vector<dvec4>& color, uint32_t i, const DoubleSvgfParams& params) {
    const Level filter(frame, signal, surfaces, color, i, params);
    std::vector<dvec4> filtered;
    for (size_t p = 0; p < frame.pixelCount(); ++p) filtered.push_back(filter.at(p));
    return filtered;
}

}  // namespace limpid::test
