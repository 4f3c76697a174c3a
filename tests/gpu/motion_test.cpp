// Compares motion with poses in double precision: the previous position of each pixel's surface point, for
// rigid, skinned and morphed movement, each with a moving camera.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "renderer/frame/frame_renderer.h"
#include "renderer/sequence/sequence.h"
#include "scene/builtin/builtin.h"
#include "scene/load/load.h"
#include "scene/motion/movement.h"
#include "scene/prepare/prepare.h"
#include "tests/gpu/trace/trace_fixture.h"
#include "tests/oracle/double_pose.h"
#include "tests/reference/moving_scenes.h"

namespace limpid::test {
namespace {

constexpr gpu::Extent extent{320, 180};

struct Projection {
    dvec2 pixel;
    double distance = 0.0;
    bool valid = false;
};

/// Perspective only.
Projection project(const CameraParams& camera, const dvec3& d, bool isDirection) {
    const dvec3 v = isDirection ? d : d - dvec3(camera.origin);
    const dvec3 right(camera.right), up(camera.up);
    const double w = glm::dot(v, dvec3(camera.forward));
    const dvec2 ndc(glm::dot(v, right) / glm::dot(right, right) / w, glm::dot(v, up) / glm::dot(up, up) / w);
    return {
        {(ndc.x * 0.5 + 0.5) * extent.width, (-ndc.y * 0.5 + 0.5) * extent.height}, glm::length(v), w > 0.0};
}

TestRay centreRay(const CameraParams& camera, uint32_t x, uint32_t y) {
    const float px = 2.0f * (static_cast<float>(x) + 0.5f) / static_cast<float>(extent.width) - 1.0f;
    const float py = 1.0f - 2.0f * (static_cast<float>(y) + 0.5f) / static_cast<float>(extent.height);
    return {camera.origin, glm::normalize(camera.forward + px * camera.right + py * camera.up), 1e30f};
}

class MotionTest : public TraceTest {
  protected:
    struct Counts {
        size_t hits = 0, skipped = 0, moved = 0, misplaced = 0, wrongMotion = 0, wrongDepth = 0,
               wrongNormal = 0, wrongSky = 0;
        double worst = 0.0;
    };

    void check(scene::Scene scene, const std::string& path, double time, double pathSeconds = 2.0) {
        if (scene.clip == scene::none) scene::chooseClip(scene, "");
        const scene::SceneData data = scene::buildSceneData(scene);
        scene::GpuScene gpuScene(device(), data, GetParam());
        const scene::Camera camera = scene.cameras.at(0);
        const Sequence sequence(scene, data, camera,
                                scene::builtinCameraPath(path, scene, camera, pathSeconds),
                                {.framesPerSecond = 30.0, .start = time - 1.0 / 30.0});
        const Moment moment = sequence.moment(1, extent);
        RenderSettings settings;
        settings.extent = extent;
        settings.jitter = Jitter::Off;
        settings.layers = true;
        settings.pathtrace.maxDepth = 0;
        FrameRenderer still(device(), gpuScene, settings, 1);
        still.render(moment);
        const RenderedLayers layers = still.download();
        const std::vector<TestHit> hits = hitsOf(gpuScene, moment.camera);
        const Counts counts =
            compare(DoublePose(scene, time), DoublePose(scene, time - 1.0 / 30.0), moment, layers, hits);
        fmt::print(
            "{}: {} hits, {} skipped, {} moved, wrong: position {}, motion {}, z {}, normal {}, sky {}; "
            "worst {:.3g} "
            "px\n",
            scene.name, counts.hits, counts.skipped, counts.moved, counts.misplaced, counts.wrongMotion,
            counts.wrongDepth, counts.wrongNormal, counts.wrongSky, counts.worst);
        const auto allowed = static_cast<size_t>(0.001 * static_cast<double>(counts.hits));
        EXPECT_GT(counts.hits, 2000u);
        EXPECT_LT(counts.skipped, counts.hits / 10);
        EXPECT_GT(counts.moved, counts.hits / 2) << "the test would prove little";
        EXPECT_LE(counts.misplaced, allowed);
        EXPECT_LE(counts.wrongMotion, allowed);
        EXPECT_LE(counts.wrongDepth, allowed);
        EXPECT_LE(counts.wrongNormal, 10 * allowed);
        EXPECT_EQ(counts.wrongSky, 0u);
    }

    /// Moves the first node in one second.
    static void slide(scene::Scene& scene, const vec3& from, const vec3& to) {
        scene.rig.clips.push_back({"moves",
                                   {{0,
                                     scene::AnimatedValue::Translation,
                                     scene::Interpolation::Linear,
                                     3,
                                     {0.0f, 1.0f},
                                     {from.x, from.y, from.z, to.x, to.y, to.z}}}});
    }

    std::vector<float> pictureAtOneSecond(const scene::Scene& scene) {
        const scene::SceneData data = scene::buildSceneData(scene);
        scene::GpuScene gpuScene(device(), data, GetParam());
        const Sequence sequence(scene, data, scene.cameras.at(0), std::nullopt, {.start = 1.0});
        RenderSettings settings;
        settings.extent = {64, 48};
        FrameRenderer renderer(device(), gpuScene, settings, 1);
        renderer.render(sequence.moment(0, settings.extent));
        return renderer.download().beauty;
    }

    std::vector<TestHit> hitsOf(const scene::GpuScene& gpuScene, const CameraParams& camera) {
        std::vector<TestRay> rays;
        for (uint32_t y = 0; y < extent.height; ++y) {
            for (uint32_t x = 0; x < extent.width; ++x) rays.push_back(centreRay(camera, x, y));
        }
        return traceThrough(gpuScene, rays);
    }

    static Counts compare(const DoublePose& now, const DoublePose& before, const Moment& moment,
                          const RenderedLayers& layers, const std::vector<TestHit>& hits) {
        Counts counts;
        for (size_t p = 0; p < hits.size(); ++p) {
            const TestHit& hit = hits[p];
            const dvec2 centre(static_cast<double>(p % extent.width) + 0.5,
                               static_cast<double>(p / extent.width) + 0.5);
            const float* motion = &layers.motion[4 * p];
            if (hit.t < 0.0f) {
                const TestRay ray = centreRay(moment.camera, static_cast<uint32_t>(p % extent.width),
                                              static_cast<uint32_t>(p / extent.width));
                const Projection was = project(*moment.previousCamera, dvec3(ray.direction), true);
                const dvec2 error = was.pixel - centre - dvec2(motion[0], motion[1]);
                const bool right = was.valid
                                       ? motion[3] == 1.0f && glm::length(error) < 0.05 && motion[2] == 0.0f
                                       : motion[3] == 0.0f;
                counts.wrongSky += !right;
                continue;
            }
            // The camera passes through back faces of single-sided triangles; the ray here does not.
            if (std::abs(layers.depth[4 * p] - hit.t) > 1e-3f * hit.t) {
                ++counts.skipped;
                continue;
            }
            ++counts.hits;
            const dvec2 b(hit.barycentrics);
            const dvec3 here = now.point(hit.instance, hit.primitive, b);
            const dvec3 there = before.point(hit.instance, hit.primitive, b);
            const Projection is = project(moment.camera, here, false);
            const Projection was = project(*moment.previousCamera, there, false);
            counts.misplaced += !(glm::length(is.pixel - centre) < 0.05);
            const dvec2 expected = was.pixel - is.pixel;
            const double error = glm::length(expected - dvec2(motion[0], motion[1]));
            counts.moved += glm::length(expected) > 0.1;
            counts.wrongMotion += !(motion[3] == 1.0f && was.valid && error < 0.05);
            if (was.valid) counts.worst = std::max(counts.worst, error);
            counts.wrongDepth += !(std::abs(was.distance - is.distance - motion[2]) < 1e-4 * is.distance);
            const dvec3 seen(vec3(layers.normal[4 * p], layers.normal[4 * p + 1], layers.normal[4 * p + 2]));
            const dvec3 old(vec3(layers.previousNormal[4 * p], layers.previousNormal[4 * p + 1],
                                 layers.previousNormal[4 * p + 2]));
            const double side = glm::dot(now.normal(hit.instance, hit.primitive, b), seen) < 0.0 ? -1.0 : 1.0;
            counts.wrongNormal +=
                !(glm::length(side * before.normal(hit.instance, hit.primitive, b) - old) < 0.01 ||
                  // Normals that face away from the viewer are tilted towards the viewer.
                  glm::length(side * now.normal(hit.instance, hit.primitive, b) - seen) > 0.002);
        }
        return counts;
    }

    void checkFile(const char* folder, const char* file, const std::string& path, double time) {
        const auto name = std::filesystem::path(LIMPID_SOURCE_DIR) / "../shared/scenes" / folder / file;
        if (!std::filesystem::exists(name))
            GTEST_SKIP() << "NOT TESTED: there is no scene in ../shared/scenes/" << folder;
        scene::Scene scene = scene::loadScene(name);
        scene::prepare(scene);
        check(std::move(scene), path, time);
    }
};

TEST_P(MotionTest, CornellMoving) {
    scene::Scene scene = scene::cornellMovingScene();
    check(scene, "shake", 0.6);
    check(scene, "dolly", 1.2);
}

TEST_P(MotionTest, SkinAndMorphTogether) {
    check(tubeScene(), "orbit", 0.3);
    check(tubeScene(), "dolly", 0.46);  // across a step of the morph weight
}

TEST_P(MotionTest, BoxAnimated) {
    checkFile("box_animated", "BoxAnimated.gltf", "orbit", 0.5);
}

TEST_P(MotionTest, CesiumMan) {
    checkFile("cesium_man", "CesiumMan.gltf", "orbit", 0.7);
}

TEST_P(MotionTest, MorphCube) {
    checkFile("morph_cube", "AnimatedMorphCube.gltf", "dolly", 1.3);
}

// Nothing that rays hit moves then.
TEST_P(MotionTest, ALightAloneMoves) {
    const vec3 from(-0.5f, 1.5f, 0.3f), to(0.6f, 1.2f, -0.2f);
    const auto picture = [&](bool moves) {
        scene::Scene scene = scene::builtinScene("cornell");
        scene::PunctualLight light;
        light.position = moves ? from : to;
        light.intensity = vec3(3.0f);
        if (moves) {
            scene.rig.nodes.push_back({.name = "light", .translation = from});
            scene.rig.order = {0};
            light.node = 0;
            slide(scene, from, to);
        }
        scene.lights.push_back(light);
        if (moves) scene::chooseClip(scene, "");
        return pictureAtOneSecond(scene);
    };
    EXPECT_EQ(picture(true), picture(false));
}

TEST_P(MotionTest, ACameraAloneMoves) {
    const auto picture = [&](bool moves) {
        scene::Scene scene = scene::builtinScene("cornell");
        scene::Camera& camera = scene.cameras.at(0);
        const vec3 by(0.2f, 0.1f, -0.3f);
        if (moves) {
            scene.rig.nodes = {{.name = "dolly"}, {.name = "camera", .parent = 0, .matrix = camera.toWorld}};
            scene.rig.order = {0, 1};
            camera.node = 1;
            slide(scene, vec3(0.0f), by);
            scene::chooseClip(scene, "");
        } else {
            camera.toWorld[3] += vec4(by, 0.0f);
        }
        return pictureAtOneSecond(scene);
    };
    EXPECT_EQ(picture(true), picture(false));
}

TEST_P(MotionTest, WithoutAPreviousFrameMotionIsInvalid) {
    scene::Scene scene = scene::cornellMovingScene();
    scene::chooseClip(scene, "");
    const scene::SceneData data = scene::buildSceneData(scene);
    scene::GpuScene gpuScene(device(), data, GetParam());
    scene::CameraKey a{0.0, {0, 0.3f, 1.0f}, {0, 0.3f, 0}}, b = a;
    b.time = 0.5;
    b.eye.x = 0.2f;
    b.cut = true;
    const Sequence sequence(scene, data, scene.cameras.at(0), scene::CameraPath("cut", {a, b}),
                            {.framesPerSecond = 10.0});
    RenderSettings settings;
    settings.extent = {32, 18};
    settings.layers = true;
    for (const uint64_t frame : {0u, 1u, 5u, 6u}) {
        FrameRenderer still(device(), gpuScene, settings, 1);
        still.render(sequence.moment(frame, settings.extent));
        const RenderedLayers layers = still.download();
        const bool valid = frame == 1 || frame == 6;
        for (size_t p = 0; p < 32 * 18; ++p)
            ASSERT_EQ(layers.motion[4 * p + 3], valid ? 1.0f : 0.0f) << frame;
    }
}

INSTANTIATE_TEST_SUITE_P(Tracers, MotionTest, testing::ValuesIn(allTracers), nameOfTracer);

}  // namespace
}  // namespace limpid::test
