// The denoiser of visibility: every pass against the version in double precision, on identical inputs (each
// frame starts from what the device stored in the previous frame), and what its users rely on.
#include "denoise/methods/visibility/visibility.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>

#include "tests/denoise/denoise_fixture.h"
#include "tests/oracle/double_denoise_fixture.h"
#include "tests/oracle/double_visibility.h"

namespace limpid::test {
namespace {

using denoise::VisibilitySettings;

constexpr double fixedStep = 1.0 / 65536.0;  ///< of visibility and deviation, in the levels
constexpr double halfRounding = 1e-3, minHalf = 1e-7, floatRounding = 1e-5;

struct Case {
    const char* name;
    SyntheticOptions options;
    VisibilitySettings settings{};
    uint32_t columns = 101, rows = 57;
    int resizeAt = -1;     ///< from this frame on the picture is smaller
    int darkensAt = -1;    ///< from this frame on a fifth is visible of what was
    bool hasNans = false;  ///< and infinities
};

DoubleVisibilityParams inDouble(const VisibilitySettings& s) {
    return {.alpha = double{s.alpha},
            .alphaFast = double{s.alphaFast},
            .normalTest = double{s.normalTest},
            .depthTest = double{s.depthTest},
            .antilag = double{s.antilag},
            .antilagNoise = double{s.antilagNoise},
            .youngRadius = s.levels > 1 ? s.youngRadius : 0,
            .phi = double{s.phi},
            .phiNormal = double{s.phiNormal},
            .phiDepth = double{s.phiDepth}};
}

/// The noisy light of a synthetic frame as visibility; 1 where nothing is seen.
HostFrame maskOf(HostFrame frame, float share = 0.5f) {
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        const bool hit = frame.depth[4 * p + 1] > 0.0f;
        for (size_t c = 0; c < 3; ++c) {
            const size_t i = 4 * p + c;
            frame.diffuse[i] =
                hit && c == 0 ? std::min(share * (frame.diffuse[i] + frame.specular[i]), 1.0f) : 0.0f;
            frame.emission[i] = hit || c > 0 ? 0.0f : 1.0f;
        }
    }
    return frame;
}

std::vector<dvec4> unpackedMoments(std::vector<dvec4> texels) {
    for (dvec4& m : texels) m.y = m.x * m.x + m.y * m.y;
    return texels;
}

using CaseParam = std::tuple<Case, gpu::Backing>;

std::string nameOf(const testing::TestParamInfo<CaseParam>& info) {
    return std::string(std::get<0>(info.param).name) +
           (std::get<1>(info.param) == gpu::Backing::Image ? "Images" : "Buffers");
}

class VisibilityPassTest : public DenoiseTest, public testing::WithParamInterface<CaseParam> {
  protected:
    static const Case& tested() { return std::get<0>(GetParam()); }
    static HostFrame frameOf(int number);

    std::vector<dvec2> signal(const std::string& pass, const std::string& nameEnd) {
        std::vector<dvec2> result;
        for (const uint32_t word : graph_.downloadUint(device(), written(pass, nameEnd))) {
            const double deviation =
                word >> 16 < 2 ? (word >> 16) * -1.0 - 1.0 : ((word >> 16) - 2) * fixedStep;
            result.emplace_back((word & 0xffffu) / 65535.0, deviation);
        }
        return result;
    }

    void compare(const HostFrame& frame);
    void compareMoments(const VisibilityAccumulated& expected, const std::vector<dvec4>& is,
                        std::vector<bool>& leftOut);
    void compareTiles(const HostFrame& frame, const VisibilityAccumulated& before,
                      const VisibilityAccumulated& after, const std::vector<dvec4>& is,
                      const std::vector<bool>& leftOut, const std::vector<double>& lags);
    void compareLevels(const HostFrame& frame, const SvgfSurfaces& surfaces,
                       const std::vector<dvec4>& moments, std::vector<dvec2> before);

    DoubleVisibilityParams params_;
    VisibilityHistory past_;
    double largestLag_ = 0.0;  ///< in the last frame
    size_t sharpTiles_ = 0, tiles_ = 0, unfilled_ = 0;
};

HostFrame VisibilityPassTest::frameOf(int number) {
    const Case& c = tested();
    const bool small = c.resizeAt >= 0 && number >= c.resizeAt;
    const bool dark = c.darkensAt >= 0 && number >= c.darkensAt;
    HostFrame frame =
        maskOf(SyntheticScene(c.options).frame(number, small ? 61 : c.columns, small ? 43 : c.rows, 7),
               dark ? 0.1f : 0.5f);
    if (!c.hasNans) return frame;
    size_t at = static_cast<size_t>(number) * 4;
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::max()}) {
        for (auto* layer : {&frame.diffuse, &frame.emission}) {
            for (size_t i = at; i < layer->size(); i += 4 * 397) (*layer)[i] = bad;
            at += 4 * 83;
        }
    }
    return frame;
}

/// If rounding moves a position across a pixel's centre, other taps are used, which the slope does not
/// include; so a few pixels may differ.
void VisibilityPassTest::compareMoments(const VisibilityAccumulated& expected, const std::vector<dvec4>& is,
                                        std::vector<bool>& leftOut) {
    size_t doubtful = 0, wrong = 0, first = 0;
    for (size_t p = 0; p < is.size(); ++p) {
        const VisibilityPixel& pixel = expected.pixels[p];
        const dvec4 tolerance =
            2.0 * halfRounding * glm::abs(expected.moments[p]) + 1e-4 * pixel.slope + 1e-6;
        const bool agrees = glm::all(glm::lessThanEqual(glm::abs(is[p] - expected.moments[p]), tolerance));
        doubtful += pixel.doubtful;
        leftOut[p] = pixel.doubtful || !agrees;
        if (pixel.doubtful || agrees) continue;
        if (wrong++ == 0) first = p;
    }
    const dvec4 &a = is[first], &b = expected.moments[first];
    EXPECT_LE(wrong, is.size() / 1000)
        << "the first is " << first << ": " << a.x << ' ' << a.y << ' ' << a.z << ' ' << a.w << " and " << b.x
        << ' ' << b.y << ' ' << b.z << ' ' << b.w;
    EXPECT_LE(doubtful, is.size() / 1000);
}

/// Of pixels that anti-lag changed, the device keeps only what they became.
void VisibilityPassTest::compareTiles(const HostFrame& frame, const VisibilityAccumulated& before,
                                      const VisibilityAccumulated& after, const std::vector<dvec4>& is,
                                      const std::vector<bool>& leftOut, const std::vector<double>& lags) {
    const size_t columns = (frame.width + 7) / 8;
    std::vector<dvec4> moments = is, errors(is.size(), dvec4(0.0));
    std::vector<bool> skipped(lags.size());
    for (size_t p = 0; p < is.size(); ++p) {
        if (after.moments[p] != before.moments[p]) {
            moments[p] = before.moments[p];
            errors[p] = halfRounding * glm::abs(moments[p]) + 1e-4 * before.pixels[p].slope + 1e-6;
        }
        if (!leftOut[p]) continue;
        const size_t x = p % frame.width / 8, y = p / frame.width / 8;
        for (size_t t = 0; t < lags.size(); ++t) {
            const size_t tx = t % columns, ty = t / columns;
            if (tx + 1 >= x && tx <= x + 1 && ty + 1 >= y && ty <= y + 1) skipped[t] = true;
        }
    }
    const SvgfTiles expected = visibilityTiles(frame, moments, params_, errors);
    ASSERT_EQ(lags.size(), expected.tiles.size());
    for (size_t t = 0; t < lags.size(); ++t) {
        largestLag_ = std::max(largestLag_, lags[t]);
        if (skipped[t]) continue;
        ++tiles_;
        sharpTiles_ += expected.error[t] < 0.1;
        ASSERT_NEAR(lags[t], expected.tiles[t], floatRounding * expected.tiles[t] + expected.error[t] + 1e-30)
            << "tile " << t;
    }
}

void VisibilityPassTest::compareLevels(const HostFrame& frame, const SvgfSurfaces& surfaces,
                                       const std::vector<dvec4>& moments, std::vector<dvec2> before) {
    const int levels = tested().settings.levels;
    for (int i = 0; i < levels; ++i) {
        const std::string pass = "visibility/level " + std::to_string(i + 1);
        std::vector<dvec2> expected = visibilityLevel(frame, surfaces, before, i, params_);
        std::vector<bool> doubtful(expected.size());
        if (i == 0) doubtful = visibilityFillYoung(frame, surfaces, before, moments, params_, expected);
        if (i + 1 == levels) {
            const std::vector<dvec4> picture = download(output_.beauty);
            for (size_t p = 0; p < picture.size(); ++p) {
                const double v = std::clamp(expected[p].x, 0.0, 1.0);
                ASSERT_NEAR(picture[p].x, v, floatRounding) << pass << " pixel " << p;
                ASSERT_EQ(picture[p], dvec4(dvec3(picture[p].x), 1.0)) << p;
            }
            return;
        }
        before = signal(pass, std::to_string(i + 1));
        for (size_t p = 0; p < before.size(); ++p) {
            for (int c = 0; c < 2 && !doubtful[p]; ++c) {
                ASSERT_NEAR(before[p][c], expected[p][c],
                            0.6 * fixedStep + floatRounding * std::abs(expected[p][c]))
                    << pass << " pixel " << p << " of " << c;
            }
        }
    }
}

void VisibilityPassTest::compare(const HostFrame& frame) {
    const SvgfSurfaces surfaces =
        decodeSurfaces(graph_.downloadUint(device(), written("surfaces", "surfaces")));
    const std::vector<dvec4> is = unpackedMoments(download("visibility/accumulate", "moments"));
    VisibilityAccumulated expected = visibilityAccumulate(frame, past_, params_);
    const VisibilityAccumulated before = expected;
    std::vector<double> lags;
    if (params_.antilag > 0.0) {
        const auto stored = graph_.downloadFloat(device(), written("visibility/lags", "tiles"));
        lags.assign(stored.begin(), stored.end());
        visibilityShorten(frame, lags, params_, expected);
    }
    std::vector<bool> leftOut(is.size());
    compareMoments(expected, is, leftOut);
    largestLag_ = 0.0;
    if (!lags.empty()) compareTiles(frame, before, expected, is, leftOut, lags);
    const std::vector<dvec2> start = signal("visibility/accumulate", "signal");
    for (size_t p = 0; p < is.size(); ++p) {
        const dvec2 v = visibilitySignal(frame, p, is[p]);
        unfilled_ += v.y == -2.0;
        // The device subtracts squares in float32.
        const double error = halfRounding * std::abs(v.y) + 2e-3 * std::sqrt(is[p].y) + fixedStep;
        ASSERT_NEAR(start[p].x, v.x, 0.6 * fixedStep) << p;
        ASSERT_NEAR(start[p].y, v.y, v.y >= 0.0 ? error : 0.0) << p;
    }
    compareLevels(frame, surfaces, is, start);
    past_ = {frame.width, frame.height, surfaces, is};
}

TEST_P(VisibilityPassTest, EveryPassAgreesWithTheFormulasInDouble) {
    const denoise::Denoiser* const method = denoise::findDenoiser("visibility");
    ASSERT_NE(method, nullptr);
    filters_ = std::get<1>(GetParam());
    params_ = inDouble(tested().settings);
    DenoiserSettings settings;
    settings.visibility = tested().settings;
    for (int number = 0; number < 8; ++number) {
        SCOPED_TRACE("frame " + std::to_string(number));
        const HostFrame frame = frameOf(number);
        denoise(*method, frame, settings);
        compare(frame);
        if (HasFatalFailure()) return;
        if (number == tested().darkensAt) {
            EXPECT_GT(largestLag_, 0.2);
        }
    }
    EXPECT_GE(sharpTiles_, tiles_ * 4 / 5);
    if (tested().hasNans) {
        EXPECT_GT(unfilled_, 5u);
    }
}

const SyntheticOptions moving{.cameraMoves = true, .objectMoves = true};
// The default of anti-lag multiplies the rounding errors of the tiles' sums, too, which would hide wrong
// lags.
const VisibilitySettings tame{.antilag = 16.0f, .antilagNoise = 1.5f};

VisibilitySettings with(float VisibilitySettings::*member, float value) {
    VisibilitySettings settings = tame;
    settings.*member = value;
    return settings;
}

VisibilitySettings withLevels(int levels) {
    VisibilitySettings settings = tame;
    settings.levels = levels;
    return settings;
}

VisibilitySettings withYoungRadius(int radius) {
    VisibilitySettings settings = tame;
    settings.youngRadius = radius;
    return settings;
}

INSTANTIATE_TEST_SUITE_P(
    Cases, VisibilityPassTest,
    testing::Combine(
        testing::Values(Case{"Static", {}, tame}, Case{"Camera", {.cameraMoves = true}, tame},
                        Case{"Object", {.objectMoves = true}, tame}, Case{"Both", moving, tame},
                        Case{"Orthographic", {.cameraMoves = true, .orthographic = true}, tame},
                        Case{.name = "Resize", .options = moving, .settings = tame, .resizeAt = 4},
                        Case{"Tiny", moving, tame, 3, 2}, Case{"Thin", {}, tame, 1, 40},
                        Case{"NoAntilag", moving, with(&VisibilitySettings::antilag, 0.0f)},
                        Case{"Slow", moving, with(&VisibilitySettings::alpha, 0.02f)},
                        Case{"Fast", moving, with(&VisibilitySettings::alpha, 0.6f)},
                        Case{"NoFill", moving, withYoungRadius(0)},
                        Case{"WideFill", moving, withYoungRadius(7)}, Case{"OneLevel", moving, withLevels(1)},
                        Case{"SixLevels", moving, withLevels(6)},
                        Case{.name = "Lag", .options = {}, .settings = tame, .darkensAt = 5},
                        Case{.name = "Nans", .options = moving, .settings = tame, .hasNans = true}),
        testing::Values(gpu::Backing::Image, gpu::Backing::Buffer)),
    nameOf);

class VisibilityTest : public DenoiseTest {
  protected:
    std::vector<float> clean(const HostFrame& frame, const VisibilitySettings& settings = {}) {
        DenoiserSettings all;
        all.visibility = settings;
        return denoise(*denoise::findDenoiser("visibility"), frame, all);
    }
};

TEST_F(VisibilityTest, SteadyVisibilityStaysAndTheSkyIsOpen) {
    const SyntheticScene scene(moving);
    for (int number = 0; number < 4; ++number) {
        HostFrame frame = maskOf(scene.frame(number, 64, 36, 1));
        for (size_t p = 0; p < frame.pixelCount(); ++p)
            if (frame.depth[4 * p + 1] > 0.0f) frame.diffuse[4 * p] = 0.375f;
        const std::vector<float> picture = clean(frame);
        for (size_t p = 0; p < frame.pixelCount(); ++p)
            ASSERT_NEAR(picture[4 * p], frame.depth[4 * p + 1] > 0.0f ? 0.375f : 1.0f, 1e-3f) << p;
    }
}

/// A plane, of which a share `open` of the rays sees the light, left of a column; right of it nothing does.
HostFrame shadowFrame(uint32_t columns, uint32_t rows, uint32_t edge, int number) {
    HostFrame frame = frontalPlane(columns, rows);
    uint32_t state = 747796405u * static_cast<uint32_t>(number + 1);
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        state = state * 1664525u + 1013904223u;
        const bool open = p % columns < edge && state >> 16 & 1u;  // one ray of two
        frame.diffuse[4 * p] = open ? 1.0f : 0.0f;
    }
    return frame;
}

/// Mean error left of the edge, well inside.
double errorUpTo(const std::vector<float>& picture, uint32_t columns, uint32_t first, uint32_t last,
                 double truth) {
    double sum = 0.0;
    size_t count = 0;
    for (size_t p = 0; p < picture.size() / 4; ++p) {
        if (p % columns < first || p % columns >= last) continue;
        sum += std::abs(picture[4 * p] - truth);
        ++count;
    }
    return sum / static_cast<double>(count);
}

TEST_F(VisibilityTest, AShadowThatMovesLeavesNoGhost) {
    constexpr uint32_t columns = 96, rows = 48;
    const auto errorAfterMove = [&](float antilag) {
        graph_.beginFrame();
        graph_.resetHistories();
        std::vector<float> picture;
        for (int number = 0; number < 44; ++number)
            picture = clean(shadowFrame(columns, rows, number < 40 ? 72 : 24, number), {.antilag = antilag});
        return errorUpTo(picture, columns, 32, 64, 0.0);
    };
    const double without = errorAfterMove(0.0f), with = errorAfterMove(VisibilitySettings{}.antilag);
    EXPECT_GT(without, 0.3) << "after four frames most of the light is still there";
    EXPECT_LT(with, 0.03);
}

TEST_F(VisibilityTest, NoiseOfOneRayVanishesAndEdgesOfShadowsStay) {
    constexpr uint32_t columns = 96, rows = 48, edge = 48;
    std::vector<float> picture;
    for (int number = 0; number < 40; ++number) picture = clean(shadowFrame(columns, rows, edge, number));
    EXPECT_LT(errorUpTo(picture, columns, 4, edge - 4, 0.5), 0.03) << "one sample's is 0.5";
    EXPECT_LT(errorUpTo(picture, columns, edge + 2, columns, 0.0), 0.02);
    EXPECT_LT(errorUpTo(picture, columns, edge - 2, edge, 0.5), 0.12);
}

TEST_F(VisibilityTest, MemoryIsWhatTheDocumentationSays) {
    constexpr uint32_t columns = 64, rows = 40;
    clean(maskOf(SyntheticScene({}).frame(0, columns, rows, 0)));
    constexpr double standIns = 2 * 16 + 4;  // one pixel each, where a level does not write an image
    const double bytes = static_cast<double>(graph_.bytesOfImagesWrittenFrom(0)) - standIns;
    EXPECT_EQ(bytes / double{columns * rows}, 60.3125);
}

}  // namespace
}  // namespace limpid::test
