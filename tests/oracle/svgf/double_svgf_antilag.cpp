// Step 4 of SVGF, anti-lag: computes the lag of tiles, and shortens histories by it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/oracle/svgf/double_svgf.h"

namespace limpid::test {
namespace {

constexpr double largestHalf = 65504.0;
constexpr size_t tileEdge = 8;
/// Histories shorter than this many frames do not count in a tile. Meant is two; the margin is for rounding.
constexpr double minLength = 1.5;
/// Smaller lags do not affect a pixel.
constexpr double minLag = 0.1;
/// The length of a history that was shortened to one frame.
constexpr double shortened = 1.0 - 0x1p-9;
/// Relative rounding error of float32, for one operation and for a sum of 64 numbers.
constexpr double rounding = 0x1p-24, sumRounding = 64 * rounding;

size_t tilesAlong(uint32_t pixels) {
    return (pixels + tileEdge - 1) / tileEdge;
}

/// Bounds the change of sqrt(value) if the value changes by `error`.
double rootError(double value, double error) {
    return std::sqrt(value + error) - std::sqrt(std::max(value - error, 0.0));
}

/// A number and the bound of its error.
struct Bounded {
    double value = 0.0, error = 0.0;
    void add(double v, double e) {
        value += v;
        error += e + sumRounding * std::abs(v);
    }
};

struct TileSums {
    Bounded lag, variance, size;
    bool doubtful = false;

    void add(const dvec4& m, const dvec4& errors, const DoubleSvgfParams& params) {
        doubtful = doubtful || std::abs(m.w - minLength) <= errors.w;
        if (m.w < minLength) return;
        const double k = svgfSteadyShare(params), v = k * std::max(m.y - m.x * m.x, 0.0);
        const double vError =
            k * (errors.y + 2.0 * std::abs(m.x) * errors.x + errors.x * errors.x + 4.0 * rounding * m.y);
        const double most = params.antilagPixel * std::sqrt(v);
        const double differenceError = errors.z + errors.x + rounding * (std::abs(m.z) + std::abs(m.x));
        // Clamping gives the median of the difference and both bounds, so its error is at most the largest
        // error of the three.
        const double maxError = params.antilagPixel * rootError(v, vError);
        lag.add(glm::clamp(m.z - m.x, -most, most),
                std::min(std::max(differenceError, maxError), 2.0 * (most + maxError)));
        variance.add(v, vError);
        size.add(std::max(m.z, m.x), std::max(errors.z, errors.x));
    }
};

/// Adds sums, and bounds their rounding.
void add(TileSums& sum, const TileSums& other) {
    sum.lag.add(other.lag.value, other.lag.error);
    sum.variance.add(other.variance.value, other.variance.error);
    sum.size.add(other.size.value, other.size.error);
    sum.doubtful = sum.doubtful || other.doubtful;
}

struct Lag {
    double value = 0.0, error = 0.0;
};

Lag lagOf(const TileSums& s, const DoubleSvgfParams& params) {
    const double size = s.size.value;
    if (s.doubtful) return {0.0, std::numeric_limits<double>::infinity()};
    if (size <= 0.0) return {};
    const double excess = std::abs(s.lag.value) - params.antilagNoise * std::sqrt(s.variance.value);
    const double lag = std::min(1.0, params.antilag * std::max(excess, 0.0) / size);
    const double excessError =
        s.lag.error + params.antilagNoise * rootError(s.variance.value, s.variance.error);
    return {lag, (params.antilag * excessError + lag * s.size.error) / size};
}

/// The sums of the 3x3 tiles around a tile.
TileSums sumsAround(const std::vector<TileSums>& sums, size_t columns, size_t tile) {
    const size_t column = tile % columns, row = tile / columns, rows = sums.size() / columns;
    TileSums around;
    for (size_t y = row > 0 ? row - 1 : 0; y <= std::min(row + 1, rows - 1); ++y) {
        for (size_t x = column > 0 ? column - 1 : 0; x <= std::min(column + 1, columns - 1); ++x)
            add(around, sums[y * columns + x]);
    }
    return around;
}

/// Interpolates bilinearly at s / 8 - 0.5 with clamped coordinates, where s is the pixel's centre.
double lagAt(const denoise::HostFrame& frame, const std::vector<double>& tiles, size_t p) {
    const size_t columns = tilesAlong(frame.width), rows = tilesAlong(frame.height);
    const dvec2 centre(static_cast<double>(p % frame.width) + 0.5,
                       static_cast<double>(p / frame.width) + 0.5);
    const dvec2 f = centre / double{tileEdge} - 0.5, first = glm::floor(f), fraction = f - first;
    double lag = 0.0;
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i) {
            const dvec2 last(static_cast<double>(columns) - 1.0, static_cast<double>(rows) - 1.0);
            const dvec2 at = glm::clamp(first + dvec2(i, j), dvec2(0.0), last);
            const double weight =
                (i == 0 ? 1.0 - fraction.x : fraction.x) * (j == 0 ? 1.0 - fraction.y : fraction.y);
            lag += weight * tiles[static_cast<size_t>(at.y) * columns + static_cast<size_t>(at.x)];
        }
    }
    return lag;
}

/// The fraction by which shortening the history moves a mean further towards the sample than step 3 did, and
/// its derivative with respect to the N' of step 3.
struct Step {
    double share = 0.0, slope = 0.0;
};

Step furtherShare(double alpha, double length, double shorter, double kept) {
    const double had = std::max(alpha, 1.0 / length), has = std::max(alpha, 1.0 / shorter);
    if (had >= 1.0) return {};
    const double left = 1.0 - had;
    const double hadSlope = 1.0 / (length * length), hasSlope = kept / (shorter * shorter);
    return {(has - had) / left, hasSlope / left + hadSlope * (1.0 - has) / (left * left)};
}

/// Moves a value towards `sample`.
void move(double& mean, double sample, const Step& step, double lengthSlope, double& slope,
          double& operands) {
    slope = slope * (1.0 - step.share) + std::abs(sample - mean) * step.slope * lengthSlope;
    operands += std::abs(sample - mean);
    mean += (sample - mean) * step.share;
}

void shorten(size_t p, double lag, const SvgfSample& sample, const DoubleSvgfParams& params,
             SvgfAccumulated& result) {
    const dvec3& x = sample.x;
    SvgfPixel& pixel = result.pixels[p];
    dvec4 &color = result.color[p], &moments = result.moments[p];
    const double kept = 1.0 - lag, length = moments.w, shorter = 1.0 + (length - 1.0) * kept;
    const double lengthSlope = pixel.momentsSlope.w;
    const Step ofColor = furtherShare(params.alpha, length, shorter, kept);
    for (int i = 0; i < 3; ++i)
        move(color[i], x[i], ofColor, lengthSlope, pixel.colorSlope[i], pixel.colorOperands[i]);
    const double l = luminance(x);
    const dvec3 values(l, l * l + sample.variance, l),
        alphas(params.alphaMoments, params.alphaMoments, params.alphaFast);
    for (int i = 0; i < 3; ++i)
        move(moments[i], values[i], furtherShare(alphas[i], length, shorter, kept), lengthSlope,
             pixel.momentsSlope[i], pixel.momentsOperands[i]);
    moments.w = shorter > 1.0 ? shorter : shortened;
    pixel.momentsSlope.w *= kept;
    color.w = std::min(svgfBoost(shorter, params.boost) * svgfDeviation(moments.x, moments.y), largestHalf);
}

}  // namespace

double svgfSteadyShare(const DoubleSvgfParams& params) {
    const auto b = [](double a) { return a / (2.0 - a); };
    const double fast = params.alphaFast, slow = params.alphaMoments;
    const double r = fast * slow / (fast + slow - fast * slow);
    if (slow == 1.0) return 0.0;
    return std::max((b(fast) + b(slow) - 2.0 * r) / (1.0 - b(slow)), 0.0);
}

SvgfTiles svgfTiles(const denoise::HostFrame& frame, const std::vector<dvec4>& moments,
                    const DoubleSvgfParams& params, const std::vector<dvec4>& errors) {
    const size_t columns = tilesAlong(frame.width), count = columns * tilesAlong(frame.height);
    std::vector<TileSums> sums(count);
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        const size_t x = p % frame.width / tileEdge, y = p / frame.width / tileEdge;
        sums[y * columns + x].add(moments[p], errors.empty() ? dvec4(0.0) : errors[p], params);
    }
    SvgfTiles result;
    for (size_t tile = 0; tile < count; ++tile) {
        const Lag own = lagOf(sums[tile], params);
        const Lag around = params.antilagAround ? lagOf(sumsAround(sums, columns, tile), params) : Lag{};
        result.tiles.push_back(std::max(own.value, around.value));
        result.error.push_back(std::max(own.error, around.error));  // of the larger of the two
    }
    return result;
}

void svgfShorten(const denoise::HostFrame& frame, SvgfSignal signal, const std::vector<double>& tiles,
                 const DoubleSvgfParams& params, SvgfAccumulated& accumulated) {
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        const double lag = lagAt(frame, tiles, p);
        const SvgfSample sample = svgfSample(frame, signal, p, params.minAlbedo);
        accumulated.pixels[p].doubtful |= std::abs(lag - minLag) < 1e-6;
        if (lag < minLag || sample.rejected || accumulated.moments[p].w <= 1.0) continue;
        shorten(p, lag, sample, params, accumulated);
    }
}

}  // namespace limpid::test
