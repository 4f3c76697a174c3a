// The oracle of visibility itself, against values computed by hand.
#include "tests/oracle/double_visibility.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/oracle/double_denoise_fixture.h"

namespace limpid::test {
namespace {

constexpr uint32_t columns = 16, rows = 9;

denoise::HostFrame planeOf(float visibility) {
    denoise::HostFrame frame = frontalPlane(columns, rows);
    for (size_t p = 0; p < frame.pixelCount(); ++p) frame.diffuse[4 * p] = visibility;
    return frame;
}

VisibilityHistory historyOf(const denoise::HostFrame& frame, const VisibilityAccumulated& accumulated) {
    return {frame.width, frame.height, svgfSurfaces(frame), accumulated.moments};
}

TEST(DoubleVisibility, SamplesAreLimitedAndTheSkyIsAdded) {
    denoise::HostFrame frame = planeOf(0.5f);
    frame.diffuse[0] = 3.0f;
    frame.diffuse[4] = -1.0f;
    frame.diffuse[8] = std::numeric_limits<float>::quiet_NaN();
    frame.emission[12] = 0.25f;
    frame.emission[16] = std::numeric_limits<float>::infinity();
    EXPECT_EQ(visibilitySample(frame, 0), 1.0);
    EXPECT_EQ(visibilitySample(frame, 1), 0.0);
    EXPECT_EQ(visibilitySample(frame, 2), std::nullopt);
    EXPECT_EQ(visibilitySample(frame, 3), 0.75);
    EXPECT_EQ(visibilitySample(frame, 4), 0.5);
}

TEST(DoubleVisibility, MeansAreThoseOfAllSamplesUntilAlphaLimitsThem) {
    const DoubleVisibilityParams params{.alpha = 0.2, .alphaFast = 0.5};
    VisibilityHistory history;
    VisibilityAccumulated now;
    for (const float x : {1.0f, 0.0f, 0.0f}) {
        const denoise::HostFrame frame = planeOf(x);
        now = visibilityAccumulate(frame, history, params);
        history = historyOf(frame, now);
    }
    EXPECT_NEAR(now.moments[40].x, 1.0 / 3.0, 1e-12);
    EXPECT_NEAR(now.moments[40].y, 1.0 / 3.0, 1e-12);
    EXPECT_NEAR(now.moments[40].z, 0.25, 1e-12);  // 1, then half of it twice
    EXPECT_EQ(now.moments[40].w, 3.0);
    for (int i = 0; i < 4; ++i) {
        const denoise::HostFrame frame = planeOf(0.0f);
        now = visibilityAccumulate(frame, history, params);
        history = historyOf(frame, now);
    }
    EXPECT_EQ(now.moments[40].w, 5.0);
    EXPECT_NEAR(now.moments[40].x, 0.2 * 0.8 * 0.8, 1e-12);  // 1 / 5 after five frames
}

TEST(DoubleVisibility, ARejectedSampleKeepsThePast) {
    const denoise::HostFrame first = planeOf(0.25f);
    const VisibilityAccumulated was = visibilityAccumulate(first, {}, {});
    const denoise::HostFrame bad = planeOf(std::numeric_limits<float>::quiet_NaN());
    const VisibilityAccumulated is = visibilityAccumulate(bad, historyOf(first, was), {});
    EXPECT_EQ(is.moments[40], was.moments[40]);
    EXPECT_EQ(visibilityAccumulate(bad, {}, {}).moments[40], dvec4(0.0));
    EXPECT_EQ(visibilitySignal(bad, 40, dvec4(0.0)), dvec2(1.0, -2.0));
}

TEST(DoubleVisibility, YoungPixelsHaveTheLargestDeviation) {
    const denoise::HostFrame frame = planeOf(1.0f);
    EXPECT_EQ(visibilitySignal(frame, 40, {1.0, 1.0, 1.0, 1.0}), dvec2(1.0, 1.0));        // 2 / sqrt(1) 0.5
    EXPECT_NEAR(visibilitySignal(frame, 40, {0.5, 0.5, 0.5, 16.0}).y, 0.5 * 0.5, 1e-12);  // 2 / sqrt(16) 0.5
}

TEST(DoubleVisibility, ShortenedHistoriesHaveTheMeanOfFewerFrames) {
    const denoise::HostFrame frame = planeOf(0.0f);
    VisibilityAccumulated now{std::vector<dvec4>(frame.pixelCount(), dvec4(0.9, 0.9, 0.5, 10.0)),
                              std::vector<VisibilityPixel>(frame.pixelCount())};
    visibilityShorten(frame, {1.0, 1.0, 1.0, 1.0}, {}, now);
    EXPECT_EQ(now.moments[40], dvec4(0.0, 0.0, 0.0, 1.0)) << "this frame alone";
}

TEST(DoubleVisibility, ALevelIsATentWhereNothingStopsIt) {
    const denoise::HostFrame frame = planeOf(0.0f);
    std::vector<dvec2> signal(frame.pixelCount(), dvec2(0.0, 1.0));
    constexpr size_t middle = 4 * columns + 8;
    signal[middle].x = 1.0;
    const DoubleVisibilityParams open{.phi = 1e9};
    const std::vector<dvec2> first = visibilityLevel(frame, svgfSurfaces(frame), signal, 0, open);
    EXPECT_NEAR(first[middle].x, 0.25, 1e-6);
    EXPECT_NEAR(first[middle + 1].x, 0.125, 1e-2);  // pixels of the plane differ a little in distance
    EXPECT_NEAR(first[middle].y, 0.375, 1e-2);      // root of (1 + 4 + 1)^2 / 16^2
    const std::vector<dvec2> second = visibilityLevel(frame, svgfSurfaces(frame), signal, 1, open);
    EXPECT_EQ(second[middle + 1].x, 0.0);
    EXPECT_NEAR(second[middle + 2].x, 0.125, 1e-2);
    const std::vector<dvec2> stopped = visibilityLevel(frame, svgfSurfaces(frame), signal, 0, {.phi = 1e-3});
    EXPECT_GT(stopped[middle].x, 0.999);
}

TEST(DoubleVisibility, AnUnknownPixelBecomesTheMeanOfItsNeighbours) {
    const denoise::HostFrame frame = planeOf(0.0f);
    std::vector<dvec2> signal(frame.pixelCount(), dvec2(0.25, 0.1));
    constexpr size_t middle = 4 * columns + 8;
    signal[middle] = dvec2(1.0, -2.0);
    const std::vector<dvec2> filled = visibilityLevel(frame, svgfSurfaces(frame), signal, 0, {});
    EXPECT_NEAR(filled[middle].x, 0.25, 1e-12);
    EXPECT_NEAR(filled[middle + 1].x, 0.25, 1e-12);
    EXPECT_GT(filled[middle].y, 0.0);
}

}  // namespace
}  // namespace limpid::test
