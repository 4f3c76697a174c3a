// Tests the oracle of temporal anti-aliasing with numbers computed by hand, and its general properties.
#include "tests/oracle/double_taa.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/oracle/double_denoise_fixture.h"

namespace limpid::test {
namespace {

using denoise::HostFrame;

constexpr uint32_t side = 9;
constexpr size_t middle = size_t{side} * 4 + 4;

/// A static plane of nine by nine pixels.
class TaaByHand : public testing::Test {
  protected:
    /// Returns a picture with colorOf(column, row).
    template <typename ColorOf>
    static std::vector<float> pictureOf(const ColorOf& colorOf) {
        std::vector<float> picture;
        for (size_t p = 0; p < size_t{side} * side; ++p) {
            const dvec3 c = colorOf(p % side, p / side);
            picture.insert(picture.end(),
                           {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z), 1});
        }
        return picture;
    }
    static std::vector<float> plain(const dvec3& color) {
        return pictureOf([&](size_t, size_t) { return color; });
    }
    static TaaPast pastOf(const dvec3& mean, double frames) {
        return {side, side, std::vector<dvec4>(size_t{side} * side, dvec4(mean, frames))};
    }
    void move(size_t p, const dvec2& by) {
        frame.motion[4 * p] = static_cast<float>(by.x);
        frame.motion[4 * p + 1] = static_cast<float>(by.y);
    }
    void moveAll(const dvec2& by) {
        for (size_t p = 0; p < frame.pixelCount(); ++p) move(p, by);
    }
    /// Computes the next frame.
    std::vector<TaaPixel> advance(const std::vector<float>& beauty) {
        const std::vector<TaaPixel> pixels = taa(frame, beauty, past, {frames, stillFrames});
        past = {side, side, {}};
        for (const TaaPixel& pixel : pixels) past.mean.emplace_back(pixel.mean, pixel.frames);
        return pixels;
    }
    TaaPixel inTheMiddle(const std::vector<float>& beauty) const {
        return taa(frame, beauty, past, {frames, stillFrames})[middle];
    }

    HostFrame frame = frontalPlane(side, side);
    TaaPast past;
    double frames = 100.0, stillFrames = 100.0;
};

TEST_F(TaaByHand, EncodingAndItsInverse) {
    const dvec3 e = taaEncode({1, 1, 1});
    EXPECT_LT(glm::distance(e, dvec3(0.5, 0, 0)), 1e-12);
    EXPECT_LT(glm::distance(taaEncode({1, 0, 0}) * 1.2126, dvec3(0.25, 0.5, -0.25)), 1e-12);
    for (const dvec3& c : {dvec3(0.0), dvec3(1, 0, 0), dvec3(0, 1e-4, 0.3), dvec3(7, 2, 40),
                           dvec3(9e5, 8e5, 1e4), dvec3(0, 0, 1e6)}) {
        EXPECT_LT(largest(taaDecode(taaEncode(c)) - c), 1e-9 * largest(c) * (1.0 + largest(c)) + 1e-15);
    }
    EXPECT_LT(glm::distance(taaDecode({0.25, 0, 0.5}), dvec3(0, 0.75, 0) / (1.0 - 0.7152 * 0.75)), 1e-12);
    EXPECT_NEAR(taaDecode({1, 0, 0}).x, 1e6, 1e-3);
}

TEST_F(TaaByHand, AConstantPictureStaysConstant) {
    moveAll({0.3, -0.4});
    for (int number = 1; number < 12; ++number) {
        const std::vector<TaaPixel> pixels = advance(plain({0.25, 4, 0.5}));
        for (const TaaPixel& pixel : pixels) ASSERT_LT(glm::distance(pixel.mean, dvec3(0.25, 4, 0.5)), 1e-12);
        ASSERT_EQ(pixels[middle].frames, number < 4 ? number : pixels[middle].frames);
        ASSERT_FALSE(pixels[middle].doubtful);
    }
}

TEST_F(TaaByHand, TheFirstFrameIsTheBeauty) {
    const std::vector<float> beauty = pictureOf([](size_t x, size_t y) { return dvec3(x, y * y, 0.5); });
    const auto expectBeauty = [&] {
        const std::vector<TaaPixel> pixels = taa(frame, beauty, past, {frames, stillFrames});
        for (size_t p = 0; p < pixels.size(); ++p) {
            const dvec3 is(beauty[4 * p], beauty[4 * p + 1], beauty[4 * p + 2]);
            ASSERT_LT(glm::distance(pixels[p].mean, is), 1e-10) << p;
            ASSERT_EQ(pixels[p].frames, 1.0);
            ASSERT_EQ(pixels[p].slope, dvec3(0.0));
        }
    };
    expectBeauty();
    past = {side - 2, side, std::vector<dvec4>(size_t{side} * (side - 2), dvec4(1, 1, 1, 5))};
    expectBeauty();  // after a resize
}

/// The light covers a quarter and three quarters of the edge's pixel in turn; the history is always within
/// the clip's range.
TEST_F(TaaByHand, AnAlternatingEdgeConvergesToTheMean) {
    const dvec3 light = taaEncode({4, 2, 1});
    std::vector<TaaPixel> pixels;
    for (int number = 0; number < 40; ++number) {
        const double share = number % 2 == 0 ? 0.25 : 0.75;
        pixels = advance(pictureOf([&](size_t x, size_t) {
            return taaDecode((x < 4 ? 1.0 : x == 4 ? share : 0.0) * light);
        }));
    }
    EXPECT_EQ(pixels[middle].frames, 40.0);
    EXPECT_LT(glm::distance(taaEncode(pixels[middle].mean), 0.5 * light), 1e-6);
    EXPECT_LT(glm::distance(pixels[middle - 1].mean, dvec3(4, 2, 1)), 1e-5);
    EXPECT_LT(glm::length(pixels[middle + 1].mean), 1e-12);
}

/// The pixel is encoded as 1/2, its neighbours as 1/4: u = 5/18, d^2 = 1/162.
TEST_F(TaaByHand, TheClipPullsThePastBack) {
    const std::vector<float> beauty =
        pictureOf([](size_t x, size_t y) { return dvec3(x == 4 && y == 4 ? 1.0 : 1.0 / 3); });
    const double u = 5.0 / 18, d = std::sqrt(1.0 / 162);
    const auto expectPast = [&](double h) {
        const TaaPixel pixel = inTheMiddle(beauty);
        EXPECT_EQ(pixel.frames, 8.0);
        EXPECT_NEAR(taaEncode(pixel.mean).x, h + (0.5 - h) / 8.0, 1e-7);
    };
    past = pastOf(dvec3(100), 7);
    expectPast(u + 1.25 * d);
    past = pastOf(dvec3(0), 7);
    expectPast(u - 1.25 * d);
    past = pastOf(dvec3(0.5), 7);  // encoded as 1/3
    expectPast(1.0 / 3);
    past = pastOf({1, 0, 0}, 7);  // grey must not become red
    expectPast(u + (0.25 / 1.2126 - u) * 1e-6 / (0.5 / 1.2126));
}

/// The beauty's pixels are alternately encoded as nearly 1 and 0, so nothing is clipped.
TEST_F(TaaByHand, TheCubicReproducesParabolas) {
    const std::vector<float> beauty =
        pictureOf([](size_t x, size_t y) { return dvec3((x + y) % 2 == 0 ? 1000.0 : 0.0); });
    const auto ramp = [](double x, double y) { return 0.3 + 0.02 * x + 0.01 * y + 0.002 * x * x; };
    past = {side, side, {}};
    for (uint32_t y = 0; y < side; ++y) {
        for (uint32_t x = 0; x < side; ++x) past.mean.emplace_back(taaDecode({ramp(x, y), 0, 0}), 3);
    }
    for (const dvec2& by : {dvec2(0), dvec2(-1.3, 0.6), dvec2(0.5, -0.25), dvec2(1.9, 2.2)}) {
        moveAll(by);
        const TaaPixel pixel = inTheMiddle(beauty);
        const double h = ramp(4.0 + by.x, 4.0 + by.y), own = 1000.0 / 1001.0;
        EXPECT_NEAR(taaEncode(pixel.mean).x, h + (own - h) / 4.0, 1e-6);
    }
}

/// Rays went through points beside the centres; the parabola through three pixels finds the centres' values.
TEST_F(TaaByHand, JitterIsUndone) {
    const auto ramp = [](double x, double y) { return 0.3 + 0.02 * x + 0.01 * y + 0.002 * x * x; };
    for (const dvec2& jitter : {dvec2(0), dvec2(0.5, -0.5), dvec2(-0.3, 0.2)}) {
        const std::vector<float> beauty = pictureOf([&](size_t x, size_t y) {
            const double at = static_cast<double>(x) + jitter.x, down = static_cast<double>(y) + jitter.y;
            return taaDecode({ramp(at, down), 0, 0});
        });
        const TaaPixel pixel = taa(frame, beauty, past, {frames, stillFrames}, jitter)[middle];
        EXPECT_NEAR(taaEncode(pixel.mean).x, ramp(4, 4), 1e-6);
    }
}

/// Beside a bright pixel the parabola leads below 0 and above the pixel's own value.
TEST_F(TaaByHand, UndoingJitterDoesNotOvershoot) {
    const auto at = [&](double brightness, const dvec2& jitter, size_t p) {
        const std::vector<float> beauty =
            pictureOf([&](size_t x, size_t) { return dvec3(x >= 5 ? brightness : 0.25); });
        return taa(frame, beauty, past, {frames, stillFrames}, jitter)[p].mean;
    };
    EXPECT_LT(glm::distance(at(50, {0.5, 0}, middle), dvec3(0.25)), 1e-6) << "dark, away from the light";
    EXPECT_LT(glm::distance(at(50, {-0.5, 0}, middle + 1), dvec3(50)), 1e-4) << "bright, away from the dark";
    EXPECT_GT(at(50, {-0.5, 0}, middle).x, 0.3) << "towards the light";
    // Each axis alone is within its limits, but together they would be brighter than any pixel.
    const std::vector<float> colors = pictureOf([](size_t x, size_t y) {
        if (x == 5) return dvec3(0, 1e4, 0);
        return y == 5 ? dvec3(1e4, 1e4, 1e4) : dvec3(0.1);
    });
    const std::vector<TaaPixel> pixels = taa(frame, colors, past, {frames, stillFrames}, {-0.5, -0.5});
    for (const TaaPixel& pixel : pixels) EXPECT_LT(largest(pixel.mean), 3e4);
}

/// Beside bright light the past may lie beyond all light, where E^-1 is infinite: where the cubic overshoots.
TEST_F(TaaByHand, ThePastIsNotBrighterThanTheLight) {
    const std::vector<float> beauty = pictureOf([](size_t x, size_t) { return dvec3(x >= 5 ? 200.0 : 0.1); });
    for (const double by : {0.25, 0.5, 0.75, 1.0}) {
        past = {side, side, {}};
        for (size_t p = 0; p < size_t{side} * side; ++p)
            past.mean.emplace_back(dvec3(p % side >= 5 ? 200.0 : 0.1), 3);
        moveAll({by, 0});
        for (const TaaPixel& pixel : advance(beauty)) EXPECT_LT(largest(pixel.mean), 200.1) << by;
    }
}

/// Edges take all frames, surfaces few of them; so do all pixels whose jitter is unknown.
TEST_F(TaaByHand, JitteredSurfacesAverageFewFrames) {
    // The beauty's pixels are alternately encoded as nearly 1 and 0, so nothing is clipped.
    const std::vector<float> beauty =
        pictureOf([](size_t x, size_t y) { return dvec3((x + y) % 2 == 0 ? 1000.0 : 0.0); });
    past = pastOf(dvec3(1), 3);
    moveAll({0, 1});
    const auto share = [&](const dvec2& jitter) {  // of this frame
        const TaaPixel pixel = taa(frame, beauty, past, {frames, stillFrames}, jitter)[middle];
        EXPECT_EQ(pixel.frames, 4.0);
        return (taaEncode(pixel.mean).x - 0.5) / (1000.0 / 1001.0 - 0.5);
    };
    constexpr double least = 1e-9;  // hardly jittered: the colour stays
    EXPECT_NEAR(share({0, 0}), 1.0 / 4, 1e-6);
    EXPECT_NEAR(share({least, 0}), 1.0 / 1.45, 1e-6);
    const auto setDistance = [&](size_t p, float z) { frame.depth[4 * p] = z; };
    for (const size_t p : {middle - side - 1, middle - side, middle + 1, middle + side + 1}) {
        const float before = frame.depth[4 * p];
        setDistance(p, 1.004f * before);
        EXPECT_NEAR(share({least, 0}), 1.0 / 1.45, 1e-6) << p;
        setDistance(p, 1.006f * before);
        EXPECT_NEAR(share({least, 0}), 1.0 / 4, 1e-6) << p;
        setDistance(p, before);
    }
    frame.depth[4 * (middle - 1)] = frame.depth[4 * (middle - 1) + 1] = 0.0f;
    EXPECT_NEAR(share({least, 0}), 1.0 / 4, 1e-6) << "next to the sky";
}

/// Where nothing moves, the limit is another one, and hard edges of light count like those of surfaces.
TEST_F(TaaByHand, WhatRestsAveragesMoreFrames) {
    frames = 2.0;
    stillFrames = 16.0;
    past = pastOf(dvec3(1), 12);
    // A line of another luma x. Beside it the picture bends as much.
    const auto lineOf = [](double luma) {
        return pictureOf([&](size_t x, size_t) { return taaDecode({x == 4 ? luma : 0.5, 0, 0}); });
    };
    const auto frameCount = [&](const dvec2& jitter, double motion) {
        moveAll({0, motion});
        return taa(frame, lineOf(0.8), past, {frames, stillFrames}, jitter)[middle].frames;
    };
    constexpr double least = 1e-9;  // hardly jittered: the colour stays
    EXPECT_EQ(frameCount({0, 0}, 0.0), 2.0);
    EXPECT_EQ(frameCount({least, 0}, 0.0), 13.0);
    EXPECT_NEAR(frameCount({least, 0}, 0.05), 9.0, 1e-5);
    EXPECT_EQ(frameCount({least, 0}, 0.2), 2.0);
    moveAll({0, 0});
    const auto averaged = [&](double luma) {
        past = pastOf(taaDecode({0.5, 0, 0}), 2);
        const TaaPixel pixel = taa(frame, lineOf(luma), past, {frames, stillFrames}, {least, 0})[middle];
        return (luma - 0.5) / (taaEncode(pixel.mean).x - 0.5);
    };
    EXPECT_NEAR(averaged(0.8), 3.0, 1e-5);
    EXPECT_NEAR(averaged(0.51), 1.15, 1e-5) << "soft";
    EXPECT_NEAR(averaged(0.6), 3.0, 1e-5) << "a bend of one third";
    const double between = (0.1 / 0.55 - 0.1) / 0.2;
    EXPECT_NEAR(averaged(0.55), 1.0 + (0.15 + 0.85 * between) * std::min(2.0, 1.0 + between * 14.0), 1e-5);
}

/// The number of frames at the target of the motion tells which pixel was taken as nearest.
TEST_F(TaaByHand, MotionIsThatOfTheNearest) {
    past = pastOf(dvec3(1), 0);
    for (size_t p = 0; p < past.mean.size(); ++p) past.mean[p].w = 1.0 + static_cast<double>(p % side);
    const auto count = [&] { return inTheMiddle(plain(dvec3(1))).frames; };
    EXPECT_EQ(count(), 6.0);
    move(middle + side + 1, {2, 0});
    frame.depth[4 * (middle + side + 1)] = 1.5f;
    EXPECT_EQ(count(), 8.0);
    move(middle - 1, {-2, 0});  // equally near, but earlier in order
    frame.depth[4 * (middle - 1)] = 1.5f;
    EXPECT_EQ(count(), 4.0);
    frame.depth[4 * middle] = 1.0f;
    EXPECT_EQ(count(), 6.0);
    frame.depth[4 * (middle + 2)] = 0.5f;  // not one of its neighbours
    move(middle + 2, {3, 0});
    EXPECT_EQ(count(), 6.0);
    for (size_t p = 0; p < frame.pixelCount(); ++p) frame.depth[4 * p] = frame.depth[4 * p + 1] = 0.0f;
    move(middle, {1, 0});
    EXPECT_EQ(count(), 7.0) << "nothing is seen";
    frame.depth[4 * (middle - 1)] = 9.0f;
    frame.depth[4 * (middle - 1) + 1] = 1.0f;
    EXPECT_EQ(count(), 4.0) << "next to the sky";
}

TEST_F(TaaByHand, WithoutMotionThePixelStartsAnew) {
    past = pastOf(dvec3(1), 5);
    const auto expectRestart = [&](bool restarts) {
        const TaaPixel pixel = inTheMiddle(plain(dvec3(2)));
        EXPECT_EQ(pixel.frames, restarts ? 1.0 : 6.0);
        EXPECT_LT(glm::distance(pixel.mean, dvec3(2)), 1e-4);  // the clip leaves no smaller difference
    };
    expectRestart(false);
    for (const dvec2& by : {dvec2(-4.6, 0), dvec2(4.6, 0), dvec2(0, -4.6), dvec2(0, 4.6)}) {
        moveAll(by);
        expectRestart(true);
        moveAll(0.95 * by);
        expectRestart(false);
    }
    moveAll(dvec2(std::numeric_limits<double>::quiet_NaN(), 0));
    expectRestart(true);
    moveAll(dvec2(0));
    for (size_t p = 0; p < frame.pixelCount(); ++p) frame.motion[4 * p + 3] = 0.0f;
    expectRestart(true);
}

TEST_F(TaaByHand, FramesAreAtMostThoseWanted) {
    past = pastOf(dvec3(1), 7);
    for (const double most : {2.5, 7.0, 8.0, 9.0}) {
        frames = most;
        EXPECT_EQ(inTheMiddle(plain(dvec3(1))).frames, std::min(most, 8.0));
    }
}

TEST_F(TaaByHand, Doubt) {
    past = pastOf(dvec3(1), 7);
    const auto doubtful = [&] { return inTheMiddle(plain(dvec3(1))).doubtful; };
    moveAll({0.50005, 0});
    EXPECT_FALSE(doubtful()) << "either way the same number";
    past.mean[middle].w = 1.0;
    EXPECT_TRUE(doubtful());
    frames = 2.0;
    EXPECT_FALSE(doubtful());
    moveAll({0, 4.49995});
    EXPECT_TRUE(doubtful()) << "next to the picture's edge";
    moveAll({0, 4.499});
    EXPECT_FALSE(doubtful());
    frame.depth[4 * (middle - 1)] = std::nextafter(2.0f, 1.0f);
    EXPECT_FALSE(doubtful()) << "either way the same motion";
    move(middle - 1, {1, 0});
    EXPECT_TRUE(doubtful());
    frame.depth[4 * (middle - 1)] = 1.99f;
    EXPECT_FALSE(doubtful());
}

TEST(DoubleTaa, SlopeAndDoubtCoverErrorsOfPosition) {
    const SyntheticScene scene({.cameraMoves = true, .objectMoves = true});
    const auto beautyOf = [&](int number) { return scene.truth(number, width, height); };
    TaaPast past;
    for (int number = 0; number < 5; ++number) {
        const std::vector<TaaPixel> pixels =
            taa(scene.frame(number, width, height, 1), beautyOf(number), past, {4.0, 4.0});
        past = {width, height, {}};
        for (const TaaPixel& pixel : pixels) past.mean.emplace_back(pixel.mean, pixel.frames);
    }
    const HostFrame frame = scene.frame(5, width, height, 1);
    HostFrame off = frame;
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        off.motion[4 * p] += 5e-5f;
        off.motion[4 * p + 1] -= 5e-5f;
    }
    const std::vector<TaaPixel> a = taa(frame, beautyOf(5), past, {4.0, 4.0}),
                                b = taa(off, beautyOf(5), past, {4.0, 4.0});
    size_t doubtful = 0, outside = 0, restarted = 0;
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        doubtful += a[p].doubtful;
        restarted += a[p].frames == 1.0;
        if (a[p].doubtful) continue;
        ASSERT_EQ(a[p].frames, b[p].frames) << p;
        outside += glm::any(
            glm::greaterThan(glm::abs(a[p].mean - b[p].mean), 1.1 * 5e-5 * a[p].slope + a[p].rounding));
    }
    EXPECT_GT(restarted, 0u);
    EXPECT_LE(doubtful, frame.pixelCount() / 1000);
    EXPECT_LE(outside, frame.pixelCount() / 1000);
}

}  // namespace
}  // namespace limpid::test
