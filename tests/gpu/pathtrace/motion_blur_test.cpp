// Tests motion blur against closed formulas: the share of the shutter's time for which a pixel sees a square.
#include <algorithm>
#include <array>
#include <numbers>

#include "renderer/long/block_renderer.h"
#include "renderer/sequence/sequence.h"
#include "scene/motion/movement.h"
#include "tests/gpu/render_fixture.h"
#include "tests/gpu/trace/trace_fixture.h"

namespace limpid::test {
namespace {

using glm::dvec2;

constexpr gpu::Extent extent{64, 16};
constexpr float radiance = 2.0f, halfSide = 0.3f, eyeDistance = 4.0f;
constexpr uint32_t samples = 192;
/// How far a share of the shutter's time may be from the formula: each of its two ends may count one of the
/// samples more or less, and the golden ratio's gaps are up to 2.618 times as wide as even ones.
constexpr double tolerance = 2.0 * 2.62 / samples;

/// A square that shines, centred at `center`, which faces +Z; a node moves it.
scene::Scene squareScene(const vec3& center, scene::Clip clip) {
    scene::Scene scene;
    scene::MeshBuilder builder("square");
    builder.quad(center + vec3(-halfSide, -halfSide, 0), center + vec3(halfSide, -halfSide, 0),
                 center + vec3(halfSide, halfSide, 0), center + vec3(-halfSide, halfSide, 0));
    scene::Material material = lambertian(vec3(0.0f));
    material.emission = vec3(radiance);
    addMesh(scene, builder.take(), material);
    scene.cameras = {scene::lookAt({0, 0, eyeDistance}, vec3(0.0f), {0, 1, 0}, 0.25f)};
    scene.rig.nodes.emplace_back();
    scene.rig.order = {0};
    scene.instances[0].node = 0;
    scene.rig.clips = {std::move(clip)};
    return scene;
}

/// One unit a second along X, and at the origin at 1 s.
scene::Clip constantSpeed() {
    return {"constant speed",
            {{0,
              scene::AnimatedValue::Translation,
              scene::Interpolation::Linear,
              3,
              {0, 2},
              {-1, 0, 0, 1, 0, 0}}}};
}

scene::CameraKey keyAt(double time, float x) {
    scene::CameraKey key{.time = time, .eye = {x, 0, eyeDistance}, .target = {x, 0, 0}};
    key.verticalFov = 0.25f;
    return key;
}

/// Position on the plane z = 0 that the pixel's centre sees.
dvec2 seenPoint(const CameraParams& camera, uint32_t x, uint32_t y) {
    const double px = 2.0 * (x + 0.5) / extent.width - 1.0, py = 1.0 - 2.0 * (y + 0.5) / extent.height;
    const dvec3 direction = dvec3(camera.forward) + px * dvec3(camera.right) + py * dvec3(camera.up);
    return dvec2(dvec3(camera.origin) - direction * (double{camera.origin.z} / direction.z));
}

/// The share of the offsets from `opens` to `closes` at which something at `at` lies in a slab of the
/// square's width that is at `speed` times the offset.
double shareOfTime(double at, double speed, double opens, double closes) {
    const double first = std::min((at - double{halfSide}) / speed, (at + double{halfSide}) / speed);
    const double last = std::max((at - double{halfSide}) / speed, (at + double{halfSide}) / speed);
    return std::max(0.0, std::min(last, closes) - std::max(first, opens)) / (closes - opens);
}

class MotionBlurTest : public RenderTest, public testing::WithParamInterface<scene::TraceOptions> {
  protected:
    void SetUp() override {
        RenderTest::SetUp();
        requireTracer(GetParam().tracer);
    }

    /// The share of the shutter's time for which each pixel's centre sees the square. One frame a second.
    std::vector<double> shares(scene::Scene scene, const std::optional<scene::CameraPath>& path,
                               const Shutter& shutter, uint64_t frame = 1) {
        if (!scene.rig.clips.empty()) scene::chooseClip(scene, "");
        const scene::SceneData data = scene::buildSceneData(scene);
        scene::GpuScene gpuScene(device(), data, GetParam());
        const Sequence sequence(scene, data, scene.cameras[0], path,
                                {.framesPerSecond = 1.0, .shutter = shutter});
        const RenderSettings settings = centred(extent.width, extent.height, 0);
        const BlockPlan plan{.samples = samples, .blockSamples = 128, .launchSamples = 1};
        FrameRenderer frames(device(), gpuScene, settings, plan.samples);
        BlockRenderer renderer(frames, plan);
        renderer.begin(sequence, frame);
        FrameSums sums(extent, plan, {});
        for (uint32_t block = 0; block < plan.blocks(); ++block) {
            renderer.render(block, [](uint32_t) { return true; });
            renderer.addTo(sums);
        }
        const std::vector<float> beauty = sums.means().beauty;
        std::vector<double> result;
        for (size_t i = 0; i < beauty.size(); i += 4) result.push_back(double{beauty[i]} / double{radiance});
        return result;
    }

    /// Compares with a square whose offset from the frame's place is `speed` times the time.
    static void expectShares(const std::vector<double>& shares, const CameraParams& camera, double speed,
                             const Shutter& shutter) {
        double error = 0.0, worst = 0.0;
        size_t partly = 0;
        for (uint32_t i = 0; i < shares.size(); ++i) {
            const dvec2 at = seenPoint(camera, i % extent.width, i / extent.width);
            const double wanted = std::abs(at.y) < double{halfSide}
                                      ? shareOfTime(at.x, speed, shutter.offset(0.0), shutter.offset(1.0))
                                      : 0.0;
            partly += wanted > 0.0 && wanted < 1.0;
            error += shares[i] - wanted;
            worst = std::max(worst, std::abs(shares[i] - wanted));
        }
        EXPECT_LT(worst, tolerance);
        EXPECT_NEAR(error / static_cast<double>(shares.size()), 0.0, 1e-3);
        EXPECT_GT(partly, 100u) << "the test would prove little";
    }
};

/// What moves at constant speed spreads as a box: an object, and everything before a camera that moves.
TEST_P(MotionBlurTest, ConstantSpeedSpreadsASquareEvenly) {
    const scene::Scene moving = squareScene(vec3(0.0f), constantSpeed());
    const CameraParams camera = scene::cameraParams(moving.cameras[0], extent.width, extent.height);
    using enum Shutter::Position;
    for (const Shutter& shutter : {Shutter{0.5, Center}, Shutter{0.5, Start}, Shutter{1.0, End}})
        expectShares(shares(moving, std::nullopt, shutter), camera, 1.0, shutter);

    scene::Scene still = squareScene(vec3(0.0f), constantSpeed());
    still.rig.clips.clear();
    const scene::CameraPath path("sideways", {keyAt(0.0, -0.8f), keyAt(2.0, 0.8f)});
    const Shutter shutter{0.7, Start};
    expectShares(shares(still, path, shutter), camera, -0.8, shutter);
}

/// A square on an arm that turns by half a turn: it is seen on the arc, and not on the chord.
TEST_P(MotionBlurTest, WhatTurnsGoesAlongTheArc) {
    const float turn = std::numbers::pi_v<float>;
    const auto rotation = [](float angle) {
        return std::array{0.0f, 0.0f, std::sin(0.5f * angle), std::cos(0.5f * angle)};
    };
    const auto a = rotation(-0.5f * turn), b = rotation(0.0f), c = rotation(0.5f * turn);
    std::vector<float> values(a.begin(), a.end());
    values.insert(values.end(), b.begin(), b.end());
    values.insert(values.end(), c.begin(), c.end());
    const float radius = 1.2f;
    const std::vector<double> seen = shares(squareScene({radius, 0, 0}, {"turn",
                                                                         {{0,
                                                                           scene::AnimatedValue::Rotation,
                                                                           scene::Interpolation::Linear,
                                                                           4,
                                                                           {0.5f, 1.0f, 1.5f},
                                                                           values}}}),
                                            std::nullopt, {1.0});
    // The square covers a point of its arc while the arm is within asin(h / r) of it.
    const auto at = [&](double x) {
        const double pixelsPerUnit = extent.width / (2.0 * double{eyeDistance} * std::tan(0.125) * 4.0);
        return seen[8 * extent.width + static_cast<uint32_t>(extent.width * 0.5 + x * pixelsPerUnit)];
    };
    const double r = double{radius}, h = double{halfSide};
    EXPECT_NEAR(at(r), 2.0 * std::asin(h / r) / std::numbers::pi, 0.03);
    EXPECT_EQ(at(0.0), 0.0) << "the chord";
    EXPECT_EQ(at(-r), 0.0);
}

/// No light of another shot: at a cut, instants beyond it are mirrored.
TEST_P(MotionBlurTest, ACutIsSharp) {
    scene::Scene still = squareScene(vec3(0.0f), constantSpeed());
    still.rig.clips.clear();
    scene::CameraKey other = keyAt(1.001, 50.0f);
    other.cut = true;
    const scene::CameraPath path("cut", {keyAt(0.0, -0.8f), keyAt(1.0, 0.0f), other});
    for (const double share : shares(still, path, {1.0, Shutter::Position::Start}, 2)) EXPECT_EQ(share, 0.0);
    const CameraParams camera = scene::cameraParams(still.cameras[0], extent.width, extent.height);
    expectShares(shares(still, path, {1.0, Shutter::Position::Center}), camera, -0.8,
                 {0.5, Shutter::Position::End});
}

INSTANTIATE_TEST_SUITE_P(Tracers, MotionBlurTest, testing::ValuesIn(ownTracers), nameOfTracer);

}  // namespace
}  // namespace limpid::test
