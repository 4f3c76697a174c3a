// Compares ambient occlusion with known answers, an independent tracer, and the path tracer under a white
// sky.
#include "passes/ambient_occlusion/ambient_occlusion.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "scene/builtin/builtin.h"
#include "tests/gpu/pass_fixture.h"
#include "tests/reference/rng_copy.h"

namespace limpid::test {
namespace {

constexpr double pi64 = std::numbers::pi;

/// Two perpendicular planes that meet in the x axis and extend 100 from it, seen from `distance`.
scene::Scene crease(float distance) {
    scene::Scene scene;
    scene::MeshBuilder builder("crease");
    builder.quad({-100, 0, 100}, {100, 0, 100}, {100, 0, 0}, {-100, 0, 0});
    builder.quad({-100, 0, 0}, {100, 0, 0}, {100, 100, 0}, {-100, 100, 0});
    addMesh(scene, builder.take(), lambertian(vec3(0.5f)));
    scene.cameras = {scene::lookAt(distance * vec3(0, 1, 1), distance * vec3(0, 0, 0.25f), {0, 1, 0}, 0.6f)};
    return scene;
}

/// A smooth sphere, a floor, small triangles and a mesh in two places above it; a corner of sky.
scene::Scene clutter() {
    scene::Scene scene = plainScene();
    const auto add = [&](scene::Mesh mesh, const mat4& place) {
        scene.meshes.push_back(std::move(mesh));
        addInstance(scene, static_cast<int>(scene.meshes.size() - 1), place);
    };
    scene::MeshBuilder floor("floor"), sphere("sphere", true);
    floor.quad({-4, -1, 4}, {4, -1, 4}, {4, -1, -4}, {-4, -1, -4});
    sphere.sphere({0.9f, -0.2f, 0.3f}, 0.9f, 10, 6);
    add(floor.take(), mat4(1.0f));
    add(sphere.take(), mat4(1.0f));
    add(triangleSoup(300, 1.0f, 11), glm::translate(mat4(1.0f), vec3(-1.0f, 0.1f, 0.0f)));
    addInstance(scene, 2, glm::scale(glm::translate(mat4(1.0f), vec3(1.0f, 1.2f, -1.5f)), vec3(0.7f)));
    scene.cameras = {scene::lookAt({0.5f, 2.0f, 5.0f}, {0, 0, 0}, {0, 1, 0}, 0.9f)};
    return scene;
}

class AmbientOcclusionTest : public PassTest {
  protected:
    struct Frame {
        GBufferImages seen;
        gpu::ImageHandle open;
    };

    Frame frame(Stage& stage, const CameraLaunch& launch, const AmbientOcclusionSettings& settings) {
        stage.graph.beginFrame();
        Frame frame;
        frame.seen = gbuffer(stage.graph, stage.scene, {.light = false}, launch);
        frame.open =
            ambientOcclusion(stage.graph, stage.scene, settings, {launch.stream, launch.seed}, frame.seen);
        stage.graph.execute(device());
        return frame;
    }

    /// Returns the mean of the red channel over frames with independent random numbers.
    std::vector<double> meanOver(Stage& stage, CameraLaunch launch, const AmbientOcclusionSettings& settings,
                                 uint32_t frames) {
        std::vector<double> sum(size_t{launch.extent.width} * launch.extent.height);
        for (uint32_t i = 0; i < frames; ++i) {
            launch.stream = i;
            const std::vector<vec4> open = pixels(stage, frame(stage, launch, settings).open);
            for (size_t p = 0; p < sum.size(); ++p) sum[p] += double{open[p].x} / frames;
        }
        return sum;
    }
};

TEST_P(AmbientOcclusionTest, APlaneAloneIsOpen) {
    scene::Scene scene = floorScene(vec3(0.5f));
    scene.cameras = {scene::lookAt({0.5f, 4, 4}, {0, 0.5f, -4}, {0, 1, 0}, 1.4f)};
    Stage stage(device(), scene, GetParam());
    for (const float radius : {0.0f, 0.2f}) {
        const Frame images = frame(stage, centredLaunch(scene, {64, 64}), {.radius = radius, .rays = 8});
        size_t hits = 0;
        for (const vec4& depth : pixels(stage, images.seen.depth)) hits += depth.y == 1.0f;
        EXPECT_GT(hits, 1000u);
        EXPECT_LT(hits, 64u * 64u) << "some pixels should see nothing";
        for (const vec4& open : pixels(stage, images.open)) ASSERT_EQ(open, vec4(1, 1, 1, 0));
    }
}

/// A perpendicular plane hides half of the cosine-weighted hemisphere. Because it ends, a share of about
/// distance / 100 is missing.
TEST_P(AmbientOcclusionTest, ARightAngleIsHalfOpen) {
    const scene::Scene scene = crease(0.1f);
    Stage stage(device(), scene, GetParam());
    constexpr uint32_t frames = 4, rays = 256;
    const std::vector<double> open =
        meanOver(stage, centredLaunch(scene, {32, 32}), {.radius = 0.0f, .rays = rays}, frames);
    double sum = 0.0, worst = 0.0;
    for (const double value : open) {
        sum += value / static_cast<double>(open.size());
        worst = std::max(worst, std::abs(value - 0.5));
    }
    fmt::print("right angle: mean {:.5f}, exactly 0.5; a pixel is off by {:.4f} at worst\n", sum, worst);
    EXPECT_NEAR(sum, 0.5, 0.0025);
    EXPECT_LT(worst, 5.0 * std::sqrt(0.25 / (frames * rays)));
}

/// A ray hits the wall within R if the direction's component towards it is at least c = distance / R.
/// Cosine-weighted directions are uniform on the disc below the hemisphere, so the share is that of a segment
/// of the unit disc.
TEST_P(AmbientOcclusionTest, ALimitedRayMissesAFarWall) {
    const scene::Scene scene = crease(2.0f);
    Stage stage(device(), scene, GetParam());
    constexpr uint32_t frames = 4, rays = 256;
    constexpr double radius = 0.8;
    const CameraLaunch launch = centredLaunch(scene, {32, 32});
    const AmbientOcclusionSettings settings{
        .radius = static_cast<float>(radius) / stage.scene.params().sceneRadius, .rays = rays};
    const std::vector<vec4> position = pixels(stage, look(stage, launch).position);
    const std::vector<double> open = meanOver(stage, launch, settings, frames);
    double sum = 0.0, expectedSum = 0.0, worst = 0.0;
    size_t partly = 0;
    for (size_t p = 0; p < open.size(); ++p) {
        // The distance to the other plane.
        const double c = double{std::max(position[p].y, position[p].z)} / radius;
        const double expected = c < 1.0 ? 1.0 - (std::acos(c) - c * std::sqrt(1.0 - c * c)) / pi64 : 1.0;
        const double sigma = std::sqrt(expected * (1.0 - expected) / (frames * rays)) + 1e-4;
        worst = std::max(worst, std::abs(open[p] - expected) / sigma);
        sum += open[p];
        expectedSum += expected;
        partly += c < 1.0;
    }
    fmt::print(
        "limited rays: {:.4f}, exactly {:.4f} ({:+.3f} %); worst pixel {:.1f} sigma; {} of {} near the "
        "wall\n",
        sum, expectedSum, 100.0 * (sum / expectedSum - 1.0), worst, partly, open.size());
    EXPECT_GT(partly, open.size() / 4);
    EXPECT_LT(partly, open.size());
    EXPECT_NEAR(sum / expectedSum, 1.0, 1.5e-3);
    EXPECT_LT(worst, 5.0);
}

/// Checks ray by ray, with the same directions in double precision and a tracer without a tree.
TEST_P(AmbientOcclusionTest, CountsTheRaysThatBruteForceFindsOpen) {
    const scene::Scene scene = clutter();
    Stage stage(device(), scene, GetParam());
    const BruteForce brute(scene);
    CameraLaunch launch = centredLaunch(scene, {40, 24});
    launch.jitter = Jitter::Pixel;
    launch.firstSample = launch.stream = 6;
    launch.seed = 3;
    constexpr uint32_t rays = 40, perDispatch = 32;
    const AmbientOcclusionSettings settings{.radius = 0.6f, .rays = rays};
    const Frame images = frame(stage, launch, settings);
    const std::vector<vec4> position = pixels(stage, images.seen.position),
                            face = pixels(stage, images.seen.geometricNormal),
                            normal = pixels(stage, images.seen.normal), open = pixels(stage, images.open);
    const float reach = settings.radius * stage.scene.params().sceneRadius;
    size_t doubtful = 0, stopped = 0, judged = 0, wrong = 0, below = 0;
    for (uint32_t p = 0; p < open.size(); ++p) {
        if (position[p].w == 0.0f) {
            EXPECT_EQ(open[p], vec4(1, 1, 1, 0));
            continue;
        }
        const dvec3 n = vec3(normal[p]), g = vec3(face[p]);
        const double s = n.z >= 0.0 ? 1.0 : -1.0, a = -1.0 / (s + n.z), b = n.x * n.y * a;
        const dvec3 tangent(1.0 + s * n.x * n.x * a, s * b, -s * n.x), bitangent(b, s + n.y * n.y * a, -n.y);
        const vec3 start = vec3(position[p]) + vec3(face[p]) * (128.0f / 16777216.0f * position[p].w);
        int found = 0, unsure = 0;
        uint32_t rng = 0;
        for (uint32_t i = 0; i < rays; ++i) {
            if (i % perDispatch == 0) rng = tea(startStream(p, launch.stream, launch.seed), 0x0cc1u + i);
            const double u = double{pcg(rng)}, phi = 2.0 * pi64 * double{pcg(rng)};
            const dvec3 d =
                std::sqrt(u) * (std::cos(phi) * tangent + std::sin(phi) * bitangent) + std::sqrt(1.0 - u) * n;
            const double side = glm::dot(d, g);
            const BruteHit hit = brute.closest({start, vec3(d), reach * 1.0001f});
            const bool misses = hit.t < 0.0 || hit.t > double{reach};
            const bool atEnd = hit.t > 0.9999 * double{reach};
            unsure += hit.doubtful || atEnd || std::abs(side) < 1e-5;
            found += side > 0.0 && misses;
            below += side <= 0.0;
        }
        doubtful += static_cast<size_t>(unsure);
        judged += rays;
        stopped += rays - static_cast<size_t>(found);
        wrong += std::abs(std::lround(open[p].x * float{rays}) - found) > unsure;
    }
    fmt::print("{} rays, {} stopped, {} of them below the surface, {} doubtful; {} pixels wrong\n", judged,
               stopped, below, doubtful, wrong);
    EXPECT_EQ(wrong, 0u);
    EXPECT_LT(doubtful, judged / 50);
    EXPECT_GT(stopped, judged / 10) << "the test would prove little";
    EXPECT_GT(below, 0u);
}

/// Without a limit, it equals a white diffuse surface's reflection of a white sky, including interpolated
/// normals.
TEST_P(AmbientOcclusionTest, IsThePathTracersWhiteSky) {
    scene::Scene scene = clutter();
    scene.materials[0] = lambertian(vec3(1.0f));
    scene.environment = {16, 8, std::vector<vec3>(128, vec3(1.0f))};
    Stage stage(device(), scene, GetParam());
    const CameraLaunch launch = centredLaunch(scene, {24, 16});
    constexpr uint32_t frames = 32, rays = 16, pathFrames = 256;
    const std::vector<double> open = meanOver(stage, launch, {.radius = 0.0f, .rays = rays}, frames);
    std::vector<double> sum(open.size()), squares(open.size());
    std::vector<vec4> depth;
    PathtraceLaunch path = pathLaunch(launch);
    PathtraceSettings settings;
    settings.maxDepth = 1;
    for (uint32_t i = 0; i < pathFrames; ++i) {
        path.stream = i;
        path.seed = 77;
        stage.graph.beginFrame();
        const PathtraceLayers traced = pathtraceLayers(stage.graph, stage.scene, settings, path);
        stage.graph.execute(device());
        depth = pixels(stage, traced.depth);
        const std::vector<vec4> diffuse = pixels(stage, traced.diffuse);
        for (size_t p = 0; p < sum.size(); ++p) {
            sum[p] += double{diffuse[p].x};
            squares[p] += double{diffuse[p].x} * double{diffuse[p].x};
        }
    }
    double total = 0.0, pathTotal = 0.0, variance = 0.0;
    size_t far = 0, judged = 0;
    for (size_t p = 0; p < open.size(); ++p) {
        if (depth[p].y == 0.0f) continue;
        const double mean = sum[p] / pathFrames;
        const double v = std::max(0.0, squares[p] / pathFrames - mean * mean) / pathFrames +
                         open[p] * (1.0 - open[p]) / (frames * rays);
        total += open[p];
        pathTotal += mean;
        variance += v;
        ++judged;
        far += std::abs(open[p] - mean) > 3.0 * std::sqrt(v) + 1e-3;
    }
    const double z = (total - pathTotal) / std::sqrt(variance);
    const auto count = static_cast<double>(judged);
    fmt::print("white sky: mean {:.5f}, the path tracer's {:.5f}, z {:.2f}; |z| > 3 at {} of {} pixels\n",
               total / count, pathTotal / count, z, far, judged);
    EXPECT_GT(judged, open.size() / 2);
    EXPECT_LE(far, judged / 50);
    EXPECT_LT(std::abs(z), 4.0);
}

/// Rays split over several dispatches are each counted once.
TEST_P(AmbientOcclusionTest, ManyRaysHaveTheMeanOfManyFrames) {
    const scene::Scene scene = clutter();
    Stage stage(device(), scene, GetParam());
    CameraLaunch launch = centredLaunch(scene, {24, 16});
    const std::vector<double> several = meanOver(stage, launch, {.radius = 0.5f, .rays = 16}, 64);
    launch.seed = 4;
    const std::vector<double> once = meanOver(stage, launch, {.radius = 0.5f, .rays = 1024}, 1);
    double difference = 0.0, variance = 0.0;
    for (size_t p = 0; p < once.size(); ++p) {
        difference += once[p] - several[p];
        variance += 2.0 * once[p] * (1.0 - once[p]) / 1024.0;
        ASSERT_EQ(once[p] * 1024.0, std::round(once[p] * 1024.0));
    }
    fmt::print("1024 rays at once: z {:.2f}\n", difference / std::sqrt(variance));
    EXPECT_LT(std::abs(difference), 4.0 * std::sqrt(variance));
}

TEST_P(AmbientOcclusionTest, EveryParameterChangesTheResult) {
    const scene::Scene scene = clutter();
    Stage stage(device(), scene, GetParam());
    const CameraLaunch launch = centredLaunch(scene, {24, 16});
    const auto open = [&](const CameraLaunch& at, const AmbientOcclusionSettings& settings) {
        return pixels(stage, frame(stage, at, settings).open);
    };
    const std::vector<vec4> before = open(launch, {});
    EXPECT_EQ(open(launch, {}), before);
    for (const ParamInfo& info : ambientOcclusionParams().infos()) {
        AmbientOcclusionSettings changed;
        ASSERT_TRUE(ambientOcclusionParams().set(changed, info.name, "1"));
        ASSERT_NE(changed, AmbientOcclusionSettings{}) << info.name;
        EXPECT_NE(open(launch, changed), before) << info.name;
    }
    CameraLaunch other = launch;
    other.stream = 1;
    EXPECT_NE(open(other, {}), before);
    other = launch;
    other.seed = 1;
    EXPECT_NE(open(other, {}), before);
}

INSTANTIATE_TEST_SUITE_P(Tracers, AmbientOcclusionTest, testing::ValuesIn(ownTracers), nameOfTracer);

}  // namespace
}  // namespace limpid::test
