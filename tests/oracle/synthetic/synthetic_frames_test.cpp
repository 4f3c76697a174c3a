// Tests properties of the synthetic frames that any correct G-buffer has.
#include <gtest/gtest.h>

#include "tests/oracle/double_denoise_fixture.h"

namespace limpid::test {
namespace {

using denoise::HostFrame;

TEST(SyntheticFrames, NoiseHasTheTruthAsItsMean) {
    const SyntheticScene scene({});
    const std::vector<float> truth = scene.truth(0, width, height);
    dvec3 sum(0.0), expected(0.0);
    for (uint32_t seed = 0; seed < 8; ++seed) {
        const HostFrame frame = scene.frame(0, width, height, seed);
        const DoubleFrame pixels(frame);
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            sum += pixels.scattered(p);
            expected += dvec3(truth[4 * p], truth[4 * p + 1], truth[4 * p + 2]) - pixels.emission(p);
        }
    }
    // 8 x 14400 samples of standard deviation 2.1: one sigma is 0.6 % of the mean.
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(sum[i] / expected[i], 1.0, 0.03);
}

/// Returns the world position of a point at this pixel position and distance.
dvec3 worldPoint(const HostFrame& frame, const dvec2& pixel, double distance) {
    const CameraParams& camera = frame.camera;
    const dvec2 screen(2.0 * pixel.x / frame.width - 1.0, 1.0 - 2.0 * pixel.y / frame.height);
    const dvec3 across = screen.x * dvec3(camera.right) + screen.y * dvec3(camera.up);
    const dvec3 forward(camera.forward);
    return dvec3(camera.origin) + (camera.orthographic != 0 ? across + distance * forward
                                                            : distance * glm::normalize(forward + across));
}

dvec2 centreOf(size_t p) {
    return {static_cast<double>(p % width) + 0.5, static_cast<double>(p / width) + 0.5};
}

TEST(SyntheticFrames, MotionLeadsBackToWhereAStillPointIs) {
    for (const bool orthographic : {false, true}) {
        const SyntheticScene scene({.cameraMoves = true, .orthographic = orthographic});
        const HostFrame now = scene.frame(7, width, height, 1), before = scene.frame(6, width, height, 1);
        const DoubleFrame pixels(now);
        for (size_t p = 0; p < now.pixelCount(); ++p) {
            if (!pixels.hit(p)) continue;
            const dvec3 m = pixels.motion(p).value();
            const dvec3 is = worldPoint(now, centreOf(p), pixels.distance(p));
            const dvec3 was = worldPoint(before, centreOf(p) + dvec2(m), pixels.distance(p) + m.z);
            ASSERT_LT(glm::distance(is, was), 1e-5) << p;
            ASSERT_EQ(pixels.normal(p), pixels.previousNormal(p));
        }
    }
}

TEST(SyntheticFrames, MotionLeadsBackToTheSameFaceOfTheBox) {
    const SyntheticScene scene({.cameraMoves = true, .objectMoves = true});
    const HostFrame now = scene.frame(7, width, height, 1), before = scene.frame(6, width, height, 1);
    const DoubleFrame nowPixels(now), beforePixels(before);
    size_t faces = 0;
    for (size_t p = 0; p < now.pixelCount(); ++p) {
        if (now.ids[2 * p] != SyntheticScene::Box) continue;
        const dvec3 m = nowPixels.motion(p).value();
        const dvec2 s = centreOf(p) + dvec2(m);
        const size_t q = static_cast<size_t>(s.y) * width + static_cast<size_t>(s.x);
        const dvec3 normal = beforePixels.normal(q);
        // Away from edges, so that q shows the same face as p.
        if (!allAround(q, 2, [&](size_t i) {
                return before.ids[2 * i] == SyntheticScene::Box && beforePixels.normal(i) == normal;
            }))
            continue;
        ++faces;
        ASSERT_LT(glm::distance(normal, nowPixels.previousNormal(p)), 1e-6);
        const dvec3 was = worldPoint(before, s, nowPixels.distance(p) + m.z);
        const dvec3 seen = worldPoint(before, centreOf(q), beforePixels.distance(q));
        ASSERT_LT(std::abs(glm::dot(was - seen, normal)), 1e-5);
    }
    EXPECT_GT(faces, 100u);
}

}  // namespace
}  // namespace limpid::test
