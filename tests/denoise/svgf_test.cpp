// Compares every pass of SVGF with the version in double precision, on identical inputs: each frame starts
// from what the device stored in the previous frame.
#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include "tests/denoise/denoise_fixture.h"
#include "tests/denoise/svgf_cases.h"
#include "tests/denoise/svgf_fixture.h"
#include "tests/oracle/svgf/double_svgf.h"

namespace limpid::test {
namespace {

DoubleSvgfParams inDouble(const SvgfSettings& s) {
    return {.minAlbedo = s.demodulate ? double{s.minAlbedo} : 0.0,
            .alpha = double{s.alpha},
            .alphaMoments = double{s.alphaMoments},
            .alphaFast = double{s.alphaFast},
            .normalTest = double{s.normalTest},
            .depthTest = double{s.depthTest},
            .relative = s.relative,
            .search = s.search,
            .reflections = s.reflections,
            .antilag = double{s.antilag},
            .antilagNoise = double{s.antilagNoise},
            .antilagPixel = double{s.antilagPixel},
            .antilagAround = s.antilagAround,
            .fireflies = double{s.fireflies},
            .youngRadius = s.levels > 1 ? s.youngRadius : 0,
            .stabilisationAlpha = double{s.stabilisationAlpha},
            .stabilisationNoise = double{s.stabilisationNoise},
            .phiColor = double{s.phiColor},
            .phiNormal = double{s.phiNormal},
            .phiDepth = double{s.phiDepth},
            .lobeTest = double{s.lobeTest},
            .phiRoughness = double{s.phiRoughness},
            .blurLevels = s.blurLevels,
            .meanLevels = s.meanLevels,
            .dampOutliers = s.dampOutliers,
            .boost = s.boost,
            .wide = s.wide,
            .position = s.position};
}

using CaseParam = std::tuple<SvgfCase, bool, gpu::Backing>;

std::string nameOf(const testing::TestParamInfo<CaseParam>& info) {
    return std::string(std::get<0>(info.param).name) + (std::get<1>(info.param) ? "Separate" : "Joint") +
           (std::get<2>(info.param) == gpu::Backing::Image ? "Images" : "Buffers");
}

/// The stored results of the steps up to the variance of young pixels.
struct Stored {
    std::vector<dvec4> color, moments;
    std::vector<double> tiles;      ///< none without anti-lag
    std::vector<dvec3> stablePast;  ///< none if filtered light is not stabilised
};

/// Of 12 bits per octahedral coordinate.
constexpr double normalRounding = 1.05e-3;
/// Of 13 bits of mantissa.
constexpr double distanceRounding = 0x1.01p-14;
constexpr double halfRounding = 1e-3, minHalf = 1e-7, floatRounding = 1e-5;
/// Anti-lag stores moments a second time, and the second moment is a square.
constexpr double momentsRounding = 2.0 * halfRounding;

/// Mean, deviation, fast mean and frames to first and second moment, fast mean and frames.
std::vector<dvec4> unpackedMoments(std::vector<dvec4> texels) {
    for (dvec4& m : texels) m.y = m.x * m.x + m.y * m.y;
    return texels;
}

/// `error` bounds float32's error of the difference of moments under the root; the result is stored as a
/// half.
bool isDeviation(double value, double expected, double error) {
    const double square = expected * expected;
    const double least = std::sqrt(std::max(square - error, 0.0)), most = std::sqrt(square + error);
    return value >= least * (1.0 - halfRounding) - minHalf && value <= most * (1.0 + halfRounding) + minHalf;
}

/// The position in float32 may be off by about 2^-16 of a pixel, which explains 1e-4 of the slope.
dvec4 toleranceOf(const dvec4& expected, const dvec4& slope, const dvec4& operands, double relative) {
    return relative * glm::abs(expected) + 1e-4 * slope + 1e-6 * operands + minHalf;
}

bool isNear(const dvec4& value, const dvec4& expected, const dvec4& slope, const dvec4& operands,
            double relative, int components) {
    const dvec4 tolerance = toleranceOf(expected, slope, operands, relative);
    for (int c = 0; c < components; ++c) {
        if (!(std::abs(value[c] - expected[c]) <= tolerance[c])) return false;
    }
    return true;
}

/// Whether `value` is what svgf_stable.glsl stores of `expected`.
bool isStored(const dvec3& value, const dvec3& expected, const dvec3& slope = dvec3(0.0)) {
    const dvec3 size = glm::abs(expected);
    const double largest = std::max({size.x, size.y, size.z});
    const dvec3 tolerance = dvec3(largest / 255.0 + 0x1p-24) + 1e-4 * slope;
    return glm::all(glm::lessThanEqual(glm::abs(value - expected), tolerance));
}

/// Whether `value` is `expected` times a factor between `least` and `most`.
bool isDimmed(const dvec4& value, const dvec4& expected, double least, double most, const SvgfPixel& pixel) {
    const dvec4 tolerance = toleranceOf(expected, pixel.colorSlope, pixel.colorOperands, halfRounding);
    for (int c = 0; c < 3; ++c) {
        const double one = least * expected[c], other = most * expected[c];
        if (!(value[c] >= std::min(one, other) - tolerance[c])) return false;
        if (!(value[c] <= std::max(one, other) + tolerance[c])) return false;
    }
    return true;
}

std::string textOf(const dvec4& v) {
    std::string result;
    for (int c = 0; c < 4; ++c) result += std::to_string(v[c]) + ' ';
    return result;
}

class SvgfPassTest : public DenoiseTest, public testing::WithParamInterface<CaseParam> {
  protected:
    void SetUp() override {
        DenoiseTest::SetUp();
        settings_ = std::get<0>(GetParam()).settings;
        settings_.separate = std::get<1>(GetParam());
        // The defaults multiply the rounding errors of the tiles' sums, too, which would hide wrong lags.
        const auto lower = [](float& value, float standard, float chosen) {
            if (value == standard) value = chosen;
        };
        lower(settings_.antilag, SvgfSettings{}.antilag, 16.0f);
        lower(settings_.antilagNoise, SvgfSettings{}.antilagNoise, 1.5f);
        lower(settings_.antilagPixel, SvgfSettings{}.antilagPixel, 1.5f);
        filters_ = std::get<2>(GetParam());
        params_ = inDouble(settings_);
    }

    static HostFrame frameOf(int number);
    void compare(const HostFrame& frame);
    SvgfSurfaces surfaces(const HostFrame& frame);
    Stored stored(const Signal& signal);
    std::vector<bool> compareAccumulated(const SvgfAccumulated& expected, const SvgfDimming& dimming,
                                         const Stored& is);
    void compareTiles(const HostFrame& frame, const SvgfAccumulated& before, const SvgfAccumulated& after,
                      const std::vector<bool>& leftOut, const Stored& is);
    void compareYoung(const HostFrame& frame, const SvgfSurfaces& surfaces, const Signal& signal,
                      const Stored& is);
    void compareLevels(const HostFrame& frame, const SvgfSurfaces& surfaces, const Signal& signal,
                       const Stored& is, std::vector<std::vector<dvec4>>& colors);
    std::vector<dvec3> stableOf(const std::string& pass, const std::string& nameEnd) {
        std::vector<dvec3> result;
        for (const uint32_t word : graph_.downloadUint(device(), written(pass, nameEnd)))
            result.push_back(decodeStable(word));
        return result;
    }
    /// The stabilised light that the last level stored; none without it.
    std::vector<dvec3> stableNow(const Signal& signal, const std::vector<dvec4>& filtered) {
        if (!stabilises()) return {};
        const std::string pass = "svgf/level " + std::to_string(settings_.levels);
        std::vector<dvec3> result = stableOf(pass, signal.name + " stable");
        for (size_t p = 0; p < result.size(); ++p)
            EXPECT_TRUE(isStored(result[p], dvec3(filtered[p]))) << pass << " pixel " << p;
        return result;
    }
    bool stabilises() const { return settings_.stabilisationAlpha < 1.0f && settings_.levels > 0; }

    SvgfSettings settings_;
    DoubleSvgfParams params_;
    std::map<std::string, SvgfHistory> before_;  ///< by signal
    double largestLag_ = 0.0;                    ///< in the last frame
    size_t tiles_ = 0, sharp_ = 0;               ///< number compared so far, and of those with errors below
                                                 ///< 0.1
    size_t dimmed_ = 0;                          ///< pixels so far
};

HostFrame SvgfPassTest::frameOf(int number) {
    const SvgfCase& c = std::get<0>(GetParam());
    const bool small = c.resizeAt >= 0 && number >= c.resizeAt;
    HostFrame frame = SyntheticScene(c.options).frame(number, small ? 61 : c.columns, small ? 43 : c.rows, 7);
    const float brightness = c.brightness * (c.jumpAt >= 0 && number >= c.jumpAt ? 3.0f : 1.0f);
    for (auto* layer : {&frame.diffuse, &frame.specular}) {
        for (float& value : *layer) value *= brightness;
    }
    if (c.hasNegatives) {
        for (size_t i = 0; i < frame.pixelCount() * 4; ++i) {
            const float factor = (i / 32) % 2 == 0 ? 1.0f : (i / 4) % 2 == 0 ? -1.0f : 0.0f;
            frame.diffuse[i] *= factor;
            frame.specular[i] *= factor;
        }
    }
    addVariances(frame, c.samples);
    if (!c.hasRoughness) frame.roughness.clear();
    if (!c.hasNans) return frame;
    size_t at = static_cast<size_t>(number) * 4 + 1;
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            std::numeric_limits<float>::max()}) {
        for (auto* layer : {&frame.diffuse, &frame.specular, &frame.albedo, &frame.albedoSpecular}) {
            for (size_t i = at; i < layer->size(); i += 4 * 997) (*layer)[i] = bad;
            for (size_t i = (at | 3u) + 8; i < layer->size(); i += 4 * 997) (*layer)[i] = bad;  // alpha
            at += 4 * 83;
        }
        for (size_t i = at - 1; i < frame.roughness.size(); i += 4 * 97) frame.roughness[i] = bad;
    }
    return frame;
}

SvgfSurfaces SvgfPassTest::surfaces(const HostFrame& frame) {
    const std::string pass = "surfaces";
    const SvgfSurfaces is = decodeSurfaces(graph_.downloadUint(device(), written(pass, "surfaces")));
    const SvgfSurfaces expected = svgfSurfaces(frame);
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        const double z = expected.distance[p];
        EXPECT_NEAR(is.distance[p], z, distanceRounding * z) << p;
        EXPECT_EQ(is.id[p], expected.id[p]) << p;
        if (z <= 0.0) continue;
        EXPECT_LT(glm::distance(is.normal[p], expected.normal[p]), normalRounding) << p;
        EXPECT_NEAR(is.roughness[p], expected.roughness[p], 0.5001 / 255) << p;
    }
    return is;
}

Stored SvgfPassTest::stored(const Signal& signal) {
    Stored result;
    result.moments = unpackedMoments(download("svgf/reproject " + signal.name, "moments"));
    if (settings_.antilag > 0.0f) {
        const std::vector<float> tiles =
            graph_.downloadFloat(device(), written("svgf/lags " + signal.name, "tiles"));
        result.tiles.assign(tiles.begin(), tiles.end());
    }
    result.color = download(withVariance(graph_, signal.name));
    if (stabilises()) result.stablePast = stableOf("svgf/reproject " + signal.name, "stable past");
    return result;
}

/// Returns the pixels that were not compared or that differ. The stored deviation is only visible where the
/// next step did not change it.
std::vector<bool> SvgfPassTest::compareAccumulated(const SvgfAccumulated& expected,
                                                   const SvgfDimming& dimming, const Stored& is) {
    const size_t count = is.moments.size();
    std::vector<bool> leftOut(count);
    size_t doubtful = 0, wrong = 0;
    for (size_t p = 0; p < count; ++p) {
        const SvgfPixel& pixel = expected.pixels[p];
        const dvec4& m = is.moments[p];
        if (pixel.failure == 1) {
            EXPECT_EQ(is.color[p].w, -1.0) << p;
        } else if (m.w >= 4.0) {
            const double boost = svgfBoost(m.w, params_.boost);
            const double expectedDeviation = std::min(boost * svgfDeviation(m.x, m.y), 65504.0);
            EXPECT_PRED3(isDeviation, is.color[p].w, expectedDeviation, boost * boost * 1e-6 * std::abs(m.y))
                << p;
        }
        doubtful += pixel.doubtful;
        leftOut[p] = pixel.doubtful;
        if (pixel.doubtful) continue;
        dimmed_ += dimming.factor[p] < 0.9 && dimming.most[p] - dimming.least[p] < 0.1;
        const bool agrees =
            isDimmed(is.color[p], expected.color[p], dimming.least[p], dimming.most[p], pixel) &&
            isNear(m, expected.moments[p], pixel.momentsSlope, pixel.momentsOperands, momentsRounding, 4) &&
            (!stabilises() || isStored(is.stablePast[p], expected.stablePast[p], pixel.stablePastSlope));
        wrong += !agrees;
        leftOut[p] = !agrees;
        EXPECT_TRUE(agrees || !pixel.rejected) << "too few to be let off, pixel " << p;
    }
    // If rounding moves a position across a pixel's centre, other taps are used, which the slope does not
    // include.
    EXPECT_LE(wrong, count / 1000);
    EXPECT_LE(doubtful, count / 1000);
    return leftOut;
}

/// Marks a tile and those around it, whose lags depend on it.
void skip(std::vector<bool>& skipped, size_t columns, size_t column, size_t row) {
    for (size_t tile = 0; tile < skipped.size(); ++tile) {
        const size_t x = tile % columns, y = tile / columns;
        if (x + 1 >= column && x <= column + 1 && y + 1 >= row && y <= row + 1) skipped[tile] = true;
    }
}

/// `before` and `after` anti-lag. The device keeps what was before only of pixels that did not change.
void SvgfPassTest::compareTiles(const HostFrame& frame, const SvgfAccumulated& before,
                                const SvgfAccumulated& after, const std::vector<bool>& leftOut,
                                const Stored& is) {
    constexpr uint32_t edge = 8;
    const size_t columns = (frame.width + edge - 1) / edge;
    std::vector<dvec4> moments = is.moments, errors(leftOut.size());
    std::vector<bool> skipped(is.tiles.size());
    for (size_t p = 0; p < leftOut.size(); ++p) {
        const SvgfPixel& pixel = before.pixels[p];
        if (after.moments[p] != before.moments[p]) {
            moments[p] = before.moments[p];
            errors[p] = toleranceOf(moments[p], pixel.momentsSlope, pixel.momentsOperands, halfRounding);
        }
        if (leftOut[p]) skip(skipped, columns, p % frame.width / edge, p / frame.width / edge);
    }
    const SvgfTiles tiles = svgfTiles(frame, moments, params_, errors);
    ASSERT_EQ(is.tiles.size(), tiles.tiles.size());
    largestLag_ = 0.0;
    for (size_t t = 0; t < is.tiles.size(); ++t) {
        largestLag_ = std::max(largestLag_, is.tiles[t]);
        if (skipped[t]) continue;
        sharp_ += tiles.error[t] < 0.1;
        ++tiles_;
        const double lag = tiles.tiles[t];
        ASSERT_NEAR(is.tiles[t], lag, floatRounding * lag + tiles.error[t] + 1e-30) << "tile " << t;
    }
}

void SvgfPassTest::compareYoung(const HostFrame& frame, const SvgfSurfaces& surfaces, const Signal& signal,
                                const Stored& is) {
    const SvgfVariance expected =
        svgfYoungVariance(frame, signal.signal, surfaces, is.color, is.moments, params_);
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        if (surfaces.distance[p] <= 0.0 || is.moments[p].w >= 4.0) continue;
        ASSERT_PRED3(isDeviation, is.color[p].w, expected.color[p].w, expected.error[p]) << p;
    }
}

/// Appends the stored result of every level to `colors`, which contains the first one's input. The last one's
/// is stabilised.
void SvgfPassTest::compareLevels(const HostFrame& frame, const SvgfSurfaces& surfaces, const Signal& signal,
                                 const Stored& is, std::vector<std::vector<dvec4>>& colors) {
    for (int i = 0; i < settings_.levels; ++i) {
        const std::string pass = "svgf/level " + std::to_string(i + 1);
        const bool last = stabilises() && i + 1 == settings_.levels;
        const bool fedBack = i + 1 == std::min(settings_.historyLevel, settings_.levels);
        std::vector<dvec4> expected =
            svgfLevel(frame, signal.signal, surfaces, colors.back(), static_cast<uint32_t>(i), params_);
        for (size_t p = 0; last && p < frame.pixelCount(); ++p) {
            const double b = svgfStableWeight(is.moments[p].w, !before_[signal.name].stable.empty(), params_);
            expected[p] = dvec4(svgfStable(expected[p], dvec4(is.stablePast[p], b), params_), expected[p].w);
        }
        std::vector<bool> doubtful(frame.pixelCount());
        if (i == 0)
            doubtful = svgfFillYoung(frame, signal.signal, surfaces, is.color, is.moments, params_, expected);
        colors.push_back(download(pass, signal.name + (fedBack ? " color" : "")));
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            if (doubtful[p]) continue;
            ASSERT_TRUE(isNear(colors.back()[p], expected[p], dvec4(0.0), dvec4(0.0), halfRounding, 4))
                << pass << " pixel " << p << ": " << textOf(colors.back()[p]) << " and "
                << textOf(expected[p]);
        }
    }
}

/// Compares all passes of the last frame.
void SvgfPassTest::compare(const HostFrame& frame) {
    const SvgfSurfaces seen = surfaces(frame);
    std::vector<SvgfFiltered> filtered;
    for (const Signal& signal : signalsOf(settings_)) {
        SCOPED_TRACE(signal.name);
        const Stored is = stored(signal);
        SvgfAccumulated expected = svgfAccumulate(frame, signal.signal, before_[signal.name], params_);
        const SvgfAccumulated lagging = expected;
        if (!is.tiles.empty()) svgfShorten(frame, signal.signal, is.tiles, params_, expected);
        std::vector<dvec4> noisy = expected.color;
        for (size_t p = 0; p < noisy.size(); ++p) noisy[p].w = is.color[p].w;
        const SvgfDimming dimming = svgfDimming(frame, signal.signal, seen, noisy, is.moments, params_);
        const std::vector<bool> leftOut = compareAccumulated(expected, dimming, is);
        if (!is.tiles.empty()) compareTiles(frame, lagging, expected, leftOut, is);
        compareYoung(frame, seen, signal, is);
        std::vector<std::vector<dvec4>> colors{is.color};
        if (!HasFatalFailure()) compareLevels(frame, seen, signal, is, colors);
        if (HasFatalFailure()) return;
        const auto fedBack = static_cast<size_t>(std::min(settings_.historyLevel, settings_.levels));
        before_[signal.name] = {frame.width,     frame.height, seen,
                                colors[fedBack], is.moments,   stableNow(signal, colors.back())};
        filtered.push_back({signal.signal, colors.back()});
    }
    const std::vector<dvec4> beauty = download(output_.beauty);
    const std::vector<dvec4> expected =
        svgfModulate(frame, filtered, settings_.demodulate ? double{settings_.minAlbedo} : 0.0);
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        ASSERT_TRUE(isNear(beauty[p], expected[p], dvec4(0.0), dvec4(0.0), floatRounding, 4))
            << "modulate, pixel " << p << ": " << textOf(beauty[p]) << " and " << textOf(expected[p]);
    }
}

TEST_P(SvgfPassTest, EveryPassAgreesWithTheFormulasInDouble) {
    const denoise::Denoiser* const method = denoise::findDenoiser("svgf");
    ASSERT_NE(method, nullptr);
    const SvgfCase& c = std::get<0>(GetParam());
    const float stabilisationAlpha = settings_.stabilisationAlpha;
    for (int number = 0; number < c.frames; ++number) {
        settings_.stabilisationAlpha = number < c.mixesFrom ? 1.0f : stabilisationAlpha;
        params_ = inDouble(settings_);
        DenoiserSettings settings;
        settings.svgf = settings_;
        SCOPED_TRACE("frame " + std::to_string(number));
        HostFrame frame = frameOf(number);
        denoise(*method, frame, settings);
        frame.variances = frame.variances && settings_.sampleVariance;  // what the formulas are given
        compare(frame);
        if (HasFatalFailure()) return;
        if (number == c.jumpAt && settings_.antilag > 0.0f) {
            EXPECT_GT(largestLag_, settings_.antilag < 1.0f ? 0.001 : 0.2);
        }
    }
    EXPECT_GE(sharp_, tiles_ * 4 / 5);
    if (settings_.fireflies > 0.0f && settings_.fireflies < 1.0f) {
        EXPECT_GT(dimmed_, 100u);
    }
}

INSTANTIATE_TEST_SUITE_P(Images, SvgfPassTest,
                         testing::Combine(testing::ValuesIn(svgfCases()), testing::Bool(),
                                          testing::Values(gpu::Backing::Image)),
                         nameOf);
INSTANTIATE_TEST_SUITE_P(Buffers, SvgfPassTest,
                         testing::Combine(testing::ValuesIn(svgfCasesInBuffers()), testing::Bool(),
                                          testing::Values(gpu::Backing::Buffer)),
                         nameOf);

}  // namespace
}  // namespace limpid::test
