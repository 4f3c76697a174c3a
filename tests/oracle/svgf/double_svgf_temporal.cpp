// Steps 1 to 3, 7 and 8 of SVGF: those that only use a pixel itself and its history.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

#include "tests/oracle/double_atrous.h"
#include "tests/oracle/double_reprojection.h"
#include "tests/oracle/svgf/double_svgf.h"

namespace limpid::test {
namespace {

constexpr double largestHalf = 65504.0;
/// The minimum number of frames that are averaged with equal weights.
constexpr double shortestHistory = 4.0;

dvec3 signalOf(const DoubleFrame& pixels, SvgfSignal signal, size_t p) {
    if (signal == SvgfSignal::Joint) return pixels.scattered(p);
    return signal == SvgfSignal::Diffuse ? pixels.diffuse(p) : pixels.specular(p);
}

/// Returns M.
dvec3 modulationOf(const DoubleFrame& pixels, SvgfSignal signal, size_t p, double minAlbedo) {
    dvec3 a(0.0);
    if (signal != SvgfSignal::Specular) a += pixels.albedo(p);
    if (signal != SvgfSignal::Diffuse) a += pixels.albedoSpecular(p);
    if (!isFiniteInFloat(a)) return dvec3(1.0);
    return glm::min(modulation(a, minAlbedo), dvec3(largestHalf));
}

/// The variance v of the luminance of x = c / M.
double varianceOf(const denoise::HostFrame& frame, SvgfSignal signal, size_t p, const dvec3& x,
                  const dvec3& c) {
    const double samples = svgfSamples(frame);
    if (samples <= 1.0) return 0.0;
    double squares = 0.0;
    if (signal != SvgfSignal::Specular) squares += double{frame.diffuse[4 * p + 3]};
    if (signal != SvgfSignal::Diffuse && !frame.specular.empty())
        squares += double{frame.specular[4 * p + 3]};
    if (!(squares > 0.0) || std::isinf(squares) || luminance(c) <= 1e-6) return 0.0;
    const double ratio = luminance(x) / luminance(c);
    return std::min(squares * ratio * ratio / (samples - 1.0), largestHalf * largestHalf);
}

std::vector<PreviousSurface> previousSurfaces(const SvgfHistory& history, size_t count) {
    std::vector<PreviousSurface> result(count);
    for (size_t q = 0; q < history.moments.size(); ++q) {
        result[q] = {history.surfaces.normal[q], history.surfaces.distance[q], history.surfaces.id[q],
                     history.moments[q].w > 0.0};
    }
    return result;
}

std::vector<double> lobeSharpness(const denoise::HostFrame& frame, SvgfSignal signal,
                                  const DoubleSvgfParams& params) {
    std::vector<double> result;
    if (signal != SvgfSignal::Specular || params.lobeTest == 0.0 || frame.roughness.empty()) return result;
    const DoubleFrame pixels(frame);
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        const double r = std::round(255.0 * pixels.roughness(p)) / 255.0;  // as it is stored
        const double alpha = std::max(r * r, 0.02);
        result.push_back(std::min(8.0 / std::pow(params.lobeTest * alpha, 2.0), 1e4 / std::numbers::log2e));
    }
    return result;
}

/// A value, and a bound of its change if the position s is off by one pixel.
struct Sloped {
    double value, slope;
};

class Accumulator {
  public:
    Accumulator(const denoise::HostFrame& frame, SvgfSignal signal, const SvgfHistory& previous,
                const DoubleSvgfParams& params)
        : frame_(frame),
          signal_(signal),
          previous_(previous),
          params_(params),
          surfaces_(previousSurfaces(previous, frame.pixelCount())),
          reprojection_{params.normalTest,
                        params.depthTest,
                        params.relative,
                        params.search,
                        true,
                        lobeSharpness(frame, signal, params)},
          reprojector_(frame, surfaces_, reprojection_) {}
    Accumulator(const Accumulator&) = delete;
    Accumulator& operator=(const Accumulator&) = delete;

    void accumulate(size_t p, SvgfAccumulated& result) const;

  private:
    struct Old {
        Resampled color, moments, stable;
    };
    std::optional<dvec3> reflectionMotion(size_t p) const;
    Reprojection reproject(size_t p, SvgfPixel& pixel) const;
    Old find(size_t p, SvgfPixel& pixel) const;
    void update(const SvgfSample& sample, const Old& old, dvec4& color, dvec4& moments,
                SvgfPixel& pixel) const;

    const denoise::HostFrame& frame_;
    SvgfSignal signal_;
    const SvgfHistory& previous_;
    const DoubleSvgfParams& params_;
    std::vector<PreviousSurface> surfaces_;
    ReprojectionParams reprojection_;
    Reprojector reprojector_;
};

/// Returns the mean reflection motion r of the 3x3 pixels around p with the same id; nothing if none has one.
std::optional<dvec3> Accumulator::reflectionMotion(size_t p) const {
    const DoubleFrame pixels(frame_);
    const size_t x = p % frame_.width, y = p / frame_.width;
    dvec3 sum(0.0);
    double count = 0.0;
    for (size_t j = y - std::min<size_t>(y, 1); j <= y + 1 && j < frame_.height; ++j) {
        for (size_t i = x - std::min<size_t>(x, 1); i <= x + 1 && i < frame_.width; ++i) {
            const size_t q = j * frame_.width + i;
            const std::optional<dvec3> r = pixels.reflectionMotion(q);
            if (!r || pixels.id(q) != pixels.id(p)) continue;
            sum += *r;
            count += 1.0;
        }
    }
    return count > 0.0 ? std::optional(sum / count) : std::nullopt;
}

/// Both look-ups, by r and by m, share one Decision: if float32 may decide otherwise in the first, it may
/// also use the other motion. The mean of r has an error of at most 1e-6 r in float32. Inside the picture
/// that is less than the rounding of s = p + 0.5 + r, so the margins for s cover it.
Reprojection Accumulator::reproject(size_t p, SvgfPixel& pixel) const {
    Decision decision;
    Reprojection found{2, {}};
    if (params_.reflections && signal_ == SvgfSignal::Specular)
        found = reprojector_.find(p, reflectionMotion(p), decision);
    pixel.reflected = found.failure == 0;
    if (!pixel.reflected) found = reprojector_.find(p, decision);
    pixel.failure = found.failure;
    pixel.doubtful = decision.doubtful();
    return found;
}

Accumulator::Old Accumulator::find(size_t p, SvgfPixel& pixel) const {
    const Reprojection found = reproject(p, pixel);
    if (found.failure != 0) return {};
    return {resample(found, [&](size_t q) { return previous_.color[q]; }),
            resample(found,
                     [&](size_t q) {
                         const dvec4& m = previous_.moments[q];
                         return dvec4(dvec3(m), m.w > 0.0 ? std::max(m.w, 1.0) : m.w);
                     }),
            resample(found, [&](size_t q) {
                return previous_.stable.empty() ? dvec4(0.0) : dvec4(previous_.stable[q], 0.0);
            })};
}

void Accumulator::update(const SvgfSample& sample, const Old& old, dvec4& color, dvec4& moments,
                         SvgfPixel& pixel) const {
    const dvec3& x = sample.x;
    const double longest = std::max(shortestHistory, 1.0 / std::min(params_.alpha, params_.alphaMoments));
    const double n = std::min(old.moments.mean.w + 1.0, longest);
    const auto blend = [&](const Sloped& was, double is, double alpha) {
        const double share = std::max(alpha, 1.0 / n);
        const double shareSlope = old.moments.slope.w / (n * n);
        return Sloped{was.value + (is - was.value) * share,
                      was.slope * (1.0 - share) + std::abs(is - was.value) * shareSlope};
    };
    for (int i = 0; i < 3; ++i) {
        const Sloped c = blend({old.color.mean[i], old.color.slope[i]}, x[i], params_.alpha);
        color[i] = c.value;
        pixel.colorSlope[i] = c.slope;
        pixel.colorOperands[i] = std::max(std::abs(old.color.mean[i]), std::abs(x[i]));
    }
    const double l = luminance(x), variance = old.moments.mean.w > 0.0 ? 0.0 : sample.variance;
    const std::array<double, 3> values{l, l * l + variance, l};
    const std::array<double, 3> alphas{params_.alphaMoments, params_.alphaMoments, params_.alphaFast};
    for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<size_t>(i);
        const Sloped m = blend({old.moments.mean[i], old.moments.slope[i]}, values[at], alphas[at]);
        moments[i] = m.value;
        pixel.momentsSlope[i] = m.slope;
        pixel.momentsOperands[i] = std::max(std::abs(old.moments.mean[i]), std::abs(values[at]));
    }
    moments.w = n;
    pixel.momentsSlope.w = old.moments.slope.w;
    pixel.momentsOperands.w = old.moments.mean.w;
}

void Accumulator::accumulate(size_t p, SvgfAccumulated& result) const {
    const SvgfSample sample = svgfSample(frame_, signal_, p, params_.minAlbedo);
    SvgfPixel& pixel = result.pixels[p];
    dvec4 &color = result.color[p], &moments = result.moments[p];
    const Old old = find(p, pixel);
    pixel.rejected = sample.rejected;
    if (pixel.failure == 1) {
        const dvec3 c = signalOf(DoubleFrame(frame_), signal_, p);
        color = dvec4(isFiniteInFloat(c) ? glm::clamp(c, -largestHalf, largestHalf) : dvec3(0.0), -1.0);
        return;
    }
    if (sample.rejected) {
        color = old.color.mean;
        moments = old.moments.mean;
        pixel.colorSlope = old.color.slope;
        pixel.momentsSlope = old.moments.slope;
    } else {
        update(sample, old, color, moments, pixel);
    }
    result.stablePast[p] = dvec3(old.stable.mean);
    pixel.stablePastSlope = dvec3(old.stable.slope);
    color = glm::clamp(color, -largestHalf, largestHalf);
    color.w =
        std::min(svgfBoost(moments.w, params_.boost) * svgfDeviation(moments.x, moments.y), largestHalf);
    pixel.colorSlope.w = 0.0;
}

}  // namespace

SvgfSurfaces svgfSurfaces(const denoise::HostFrame& frame) {
    const DoubleFrame pixels(frame);
    SvgfSurfaces surfaces;
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        surfaces.normal.push_back(pixels.normal(p));
        surfaces.distance.push_back(pixels.distance(p));
        surfaces.id.push_back(pixels.id(p));
        surfaces.roughness.push_back(pixels.roughness(p));
    }
    return surfaces;
}

SvgfSurfaces decodeSurfaces(const std::vector<uint32_t>& words) {
    SvgfSurfaces surfaces;
    for (size_t i = 0; i + 1 < words.size(); i += 2) {
        surfaces.normal.push_back(decodeOctahedral(words[i], 12));
        const uint32_t place = words[i + 1], exponent = place >> 26, mantissa = place >> 13 & 0x1FFFu;
        surfaces.distance.push_back(
            exponent > 0 ? std::ldexp(1.0 + mantissa / 8192.0, static_cast<int>(exponent) - 32) : 0.0);
        surfaces.id.push_back(place & 0x1FFFu);
        surfaces.roughness.push_back((words[i] >> 24) / 255.0);
    }
    return surfaces;
}

SvgfSample svgfSample(const denoise::HostFrame& frame, SvgfSignal signal, size_t p, double minAlbedo) {
    const DoubleFrame pixels(frame);
    const dvec3 c = signalOf(pixels, signal, p);
    if (!isFiniteInFloat(c)) return {dvec3(0.0), true};
    const dvec3 x = glm::clamp(c / modulationOf(pixels, signal, p, minAlbedo), -largestHalf, largestHalf);
    return {x, false, varianceOf(frame, signal, p, x, c)};
}

double svgfDeviation(double m1, double m2, double error) {
    return std::min(std::sqrt(std::max(m2 - m1 * m1 + error, 0.0)), largestHalf);
}

double svgfBoost(double frames, bool boost) {
    return boost ? 2.0 / std::sqrt(std::max(frames, 1.0)) : 1.0;
}

SvgfAccumulated svgfAccumulate(const denoise::HostFrame& frame, SvgfSignal signal,
                               const SvgfHistory& previous, const DoubleSvgfParams& params) {
    const bool fits = previous.width == frame.width && previous.height == frame.height;
    const SvgfHistory none;
    const Accumulator accumulator(frame, signal, fits ? previous : none, params);
    const std::vector<dvec4> zeros(frame.pixelCount(), dvec4(0.0));
    SvgfAccumulated result{zeros, zeros, std::vector<dvec3>(frame.pixelCount(), dvec3(0.0)),
                           std::vector<SvgfPixel>(frame.pixelCount())};
    for (size_t p = 0; p < frame.pixelCount(); ++p) accumulator.accumulate(p, result);
    return result;
}

double svgfStableWeight(double frames, bool wasStable, const DoubleSvgfParams& params) {
    if (!wasStable || frames == 0.0 || frames == 1.0) return 1.0;
    return std::max(params.stabilisationAlpha, std::min(1.0 / frames, 0.5));
}

dvec3 decodeStable(uint32_t word) {
    dvec3 light(0.0);
    for (int c = 0; c < 3; ++c) {
        const auto bits = static_cast<int>(word >> (9 * c) & 0x1FFu);
        light[c] = std::ldexp(bits < 256 ? bits : bits - 512, static_cast<int>(word >> 27) - 23);
    }
    return light;
}

dvec3 svgfStable(const dvec4& color, const dvec4& past, const DoubleSvgfParams& params) {
    const dvec3 c(color), h(past);
    const double tolerated =
        params.stabilisationNoise * std::max(color.w, 0.0) + 0.001 * std::abs(luminance(c));
    const double change = std::abs(luminance(h) - luminance(c));
    const double trust = change > tolerated ? tolerated / change : 1.0;
    return c + (1.0 - past.w) * trust * (h - c);
}

std::vector<dvec4> svgfModulate(const denoise::HostFrame& frame, const std::vector<SvgfFiltered>& signals,
                                double minAlbedo) {
    const DoubleFrame pixels(frame);
    std::vector<dvec4> result;
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        dvec3 sum = pixels.emission(p);
        for (const SvgfFiltered& filtered : signals) {
            const bool divided = filtered.color[p].w >= 0.0;
            sum += dvec3(filtered.color[p]) *
                   (divided ? modulationOf(pixels, filtered.signal, p, minAlbedo) : dvec3(1.0));
        }
        result.emplace_back(sum, 1.0);
    }
    return result;
}

}  // namespace limpid::test
