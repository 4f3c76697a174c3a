// Tests properties of the oracle of temporal accumulation on whole frames that any correct implementation
// has.
#include "tests/oracle/double_temporal.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/oracle/double_denoise_fixture.h"

namespace limpid::test {
namespace {

using denoise::HostFrame;

TemporalResult trackFrames(const SyntheticScene& scene, int frames, const DoubleTemporalParams& params = {}) {
    TemporalResult result;
    for (int i = 0; i < frames; ++i)
        result = accumulateTemporally(scene.frame(i, width, height, 1), result.images, params);
    return result;
}

TEST(DoubleTemporal, StaticFramesGiveTheProgressiveMean) {
    const SyntheticScene scene({});
    TemporalResult result;
    std::vector<dvec3> sums(size_t{width} * height, dvec3(0.0));
    for (int i = 0; i < 6; ++i) {
        const HostFrame frame = scene.frame(i, width, height, 1);
        const DoubleFrame pixels(frame);
        result = accumulateTemporally(frame, result.images, {});
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            sums[p] += pixels.scattered(p);
            const TemporalPixel& pixel = result.pixels[p];
            ASSERT_EQ(pixel.failure, !pixels.hit(p) ? 1 : i == 0 ? 2 : 0);
            ASSERT_FALSE(pixel.doubtful || pixel.rejected);
            const double count = pixels.hit(p) ? i + 1.0 : 1.0;
            ASSERT_EQ(result.images.colour[p].w, count);
            ASSERT_LT(largest(dvec3(result.images.colour[p]) - sums[p] / count),
                      1e-12 * (1.0 + largest(sums[p])));
        }
    }
}

TEST(DoubleTemporal, ATranslatedCameraFindsTheFloorAgain) {
    for (const bool orthographic : {false, true}) {
        const SyntheticScene scene({.cameraMoves = true, .orthographic = orthographic});
        const HostFrame now = scene.frame(1, width, height, 1), before = scene.frame(0, width, height, 1);
        const DoubleFrame pixels(now);
        for (const bool search : {false, true}) {
            const DoubleTemporalParams params{.search = search};
            const TemporalResult result =
                accumulateTemporally(now, accumulateTemporally(before, {}, params).images, params);
            size_t floor = 0, found = 0, grazing = 0, grazingFound = 0, doubtful = 0;
            for (size_t p = 0; p < now.pixelCount(); ++p) {
                if (!allAround(p, 3, [&](size_t q) { return isFloor(now, q); })) continue;
                const dvec3 ray = orthographic ? dvec3(now.camera.forward) : glm::normalize(pixels.ray(p));
                const bool flat = std::abs(ray.y) < 0.12, history = result.pixels[p].failure == 0;
                ++floor;
                found += history;
                grazing += flat;
                grazingFound += flat && history;
                doubtful += result.pixels[p].doubtful;
            }
            EXPECT_GT(floor, 2000u);
            EXPECT_GT(grazing, 300u);
            EXPECT_GT(static_cast<double>(found), 0.95 * static_cast<double>(floor));
            EXPECT_GT(static_cast<double>(grazingFound), 0.95 * static_cast<double>(grazing));
            EXPECT_LT(static_cast<double>(doubtful), 0.02 * static_cast<double>(floor));
        }
    }
}

TEST(DoubleTemporal, WhatAnObjectUncoversHasNoHistory) {
    const SyntheticScene scene({.objectMoves = true});
    const HostFrame before = scene.frame(0, width, height, 1), now = scene.frame(1, width, height, 1);
    const auto wasBox = [&](size_t p) { return before.ids[2 * p] == SyntheticScene::Box; };
    const TemporalResult result = trackFrames(scene, 2);
    const TemporalResult grey = trackFrames(scene, 2, {.greyRestart = true});
    size_t uncovered = 0;
    for (size_t p = 0; p < now.pixelCount(); ++p) {
        const uint32_t id = now.ids[2 * p];
        if (id == SyntheticScene::Box) continue;
        if (id == UINT32_MAX) {
            ASSERT_EQ(grey.images.colour[p].w, 1.0);
            continue;
        }
        if (!wasBox(p)) {
            ASSERT_EQ(result.pixels[p].failure, 0);
        } else if (allAround(p, 1, wasBox)) {
            ++uncovered;
            const dvec3 c = DoubleFrame(now).scattered(p);
            ASSERT_EQ(result.pixels[p].failure, 3);
            ASSERT_EQ(result.images.colour[p], dvec4(c, 1.0));
            ASSERT_EQ(grey.images.colour[p].w, 2.0);
            ASSERT_LT(largest(dvec3(grey.images.colour[p]) - 0.5 * (c + 0.5)), 1e-12);
        }
    }
    EXPECT_GT(uncovered, 30u);
}

TEST(DoubleTemporal, InvalidSamplesLeaveTheHistoryAlone) {
    const SyntheticScene scene({});
    const TemporalResult before = trackFrames(scene, 3, {.maxHistory = 2});
    HostFrame frame = scene.frame(3, width, height, 1);
    const size_t p = frame.pixelCount() - width / 2;  // the floor at the bottom
    frame.diffuse[4 * p] = std::numeric_limits<float>::quiet_NaN();
    // Both are finite, but their sum overflows in float32.
    frame.diffuse[4 * p + 5] = frame.specular[4 * p + 5] = std::numeric_limits<float>::max();
    const TemporalResult after = accumulateTemporally(frame, before.images, {.maxHistory = 2});
    for (const size_t q : {p, p + 1}) {
        EXPECT_TRUE(after.pixels[q].rejected);
        EXPECT_LT(glm::distance(after.images.colour[q], before.images.colour[q]), 1e-12);
    }
    EXPECT_FALSE(after.pixels[p + 2].rejected);
    EXPECT_EQ(after.images.colour[p + 2].w, 2.0);
    const TemporalResult first = accumulateTemporally(frame, {}, {});
    EXPECT_EQ(first.images.colour[p], dvec4(0.0));
}

TEST(DoubleTemporal, TheScaleOfTheSceneDoesNotMatter) {
    const TemporalResult small = trackFrames(SyntheticScene({.cameraMoves = true, .objectMoves = true}), 4);
    const TemporalResult large =
        trackFrames(SyntheticScene({.cameraMoves = true, .objectMoves = true, .scale = 1000.0}), 4);
    size_t doubtful = 0;
    for (size_t p = 0; p < small.pixels.size(); ++p) {
        if (small.pixels[p].doubtful || large.pixels[p].doubtful) {
            ++doubtful;
        } else {
            ASSERT_EQ(small.pixels[p].failure, large.pixels[p].failure) << p;
        }
    }
    EXPECT_LT(doubtful, small.pixels.size() / 50);
}

TEST(DoubleTemporal, SlopeAndDoubtCoverErrorsOfPosition) {
    const SyntheticScene scene({.cameraMoves = true, .objectMoves = true});
    const TemporalImages before = trackFrames(scene, 5).images;
    const HostFrame frame = scene.frame(5, width, height, 1);
    HostFrame off = frame;
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        off.motion[4 * p] += 2e-4f;
        off.motion[4 * p + 1] -= 2e-4f;
    }
    const TemporalResult a = accumulateTemporally(frame, before, {}),
                         b = accumulateTemporally(off, before, {});
    size_t compared = 0, outside = 0;
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        if (a.pixels[p].doubtful) continue;
        ++compared;
        ASSERT_EQ(a.pixels[p].failure, b.pixels[p].failure);
        const dvec4 difference = glm::abs(a.images.colour[p] - b.images.colour[p]);
        const dvec4 bound = 1.1 * 2e-4 * a.pixels[p].slope + 1e-9;
        outside += glm::any(glm::greaterThan(difference, bound));
    }
    EXPECT_GT(compared, frame.pixelCount() * 9 / 10);
    // If s passes a pixel's centre, other taps are used, which the slope does not include.
    EXPECT_LT(outside, compared / 500);
}

}  // namespace
}  // namespace limpid::test
