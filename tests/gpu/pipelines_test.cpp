// Whole pipelines: what they must give, whatever the scene.
#include <gmock/gmock.h>

#include <algorithm>

#include "image/tonemap.h"
#include "renderer/frame/frame_renderer.h"
#include "renderer/frame/parameters.h"
#include "renderer/frame/sequence.h"
#include "scene/builtin/builtin.h"
#include "scene/model/prepare.h"
#include "tests/gpu/render_fixture.h"

namespace limpid::test {
namespace {

using scene::Scene;

Scene prepared(Scene scene) {
    scene::prepare(scene);
    return scene;
}

RenderSettings settingsFor(const char* pipeline, uint32_t width, uint32_t height) {
    RenderSettings settings;
    settings.extent = {width, height};
    settings.pipeline = parsePipeline(pipeline);
    settings.jitter = Jitter::Off;
    return settings;
}

class PipelinesTest : public RenderTest {
  protected:
    /// The camera stands still; every frame has noise of its own.
    static Moment still(const Scene& scene, const RenderSettings& settings, uint64_t number) {
        Moment moment;
        moment.camera = camera(scene, settings);
        if (number > 0) moment.previousCamera = moment.camera;
        moment.number = number;
        return moment;
    }

    /// The last picture of an orbit of some frames.
    std::vector<float> orbit(const Scene& scene, const RenderSettings& settings, uint64_t frames) {
        const scene::SceneData data = scene::buildSceneData(scene);
        scene::GpuScene gpuScene(device(), data);
        const SequenceTiming timing;
        const Sequence sequence(
            scene, data, scene.cameras.at(0),
            scene::builtinCameraPath("orbit", scene, scene.cameras.at(0), timing.timeOf(frames)), timing);
        FrameRenderer renderer(device(), gpuScene, settings, 1);
        for (uint64_t frame = 0; frame < frames; ++frame)
            renderer.render(sequence.moment(frame, settings.extent));
        return renderer.download().beauty;
    }
};

void expectEqual(const std::vector<float>& values, const std::vector<float>& expected, float relative) {
    ASSERT_EQ(values.size(), expected.size());
    for (size_t i = 0; i < values.size(); ++i) {
        if (i % 4 == 3) continue;
        ASSERT_NEAR(values[i], expected[i], relative * (1.0f + std::abs(expected[i]))) << i / 4;
    }
}

TEST_F(PipelinesTest, HistoryOfAStillCameraIsTheProgressiveMeanOfTheSameSamples) {
    const Scene scene = prepared(scene::cornellSpheresScene());
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    RenderSettings settings = settingsFor("history", 96, 54);
    assign(settings, "history.max_history=0");
    constexpr uint64_t frames = 48;
    FrameRenderer renderer(device(), gpuScene, settings, 1);
    for (uint64_t frame = 0; frame < frames; ++frame) renderer.render(still(scene, settings, frame));

    RenderSettings path = settings;
    path.pipeline = {};
    path.layers = true;
    ProgressiveStill mean(device(), gpuScene, frames);
    mean.update(camera(scene, path), path);
    while (mean.launch()) continue;
    const image::Image expected = beautyOf(mean.download());
    const image::Image picture = beautyOf(renderer.download());
    for (size_t i = 0; i < expected.pixels.size(); ++i)
        ASSERT_NEAR(picture.pixels[i], expected.pixels[i], 1e-5f * (1.0f + expected.pixels[i])) << i / 3;
}

TEST_F(PipelinesTest, AFrameOfSeveralLaunchesHasTheMeanOfAllItsSamples) {
    const Scene scene = prepared(scene::cornellScene());
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    RenderSettings settings = settingsFor("history", 48, 27);
    settings.samplesPerLaunch = 3;
    settings.layers = true;
    FrameRenderer renderer(device(), gpuScene, settings, 8);
    renderer.render(still(scene, settings, 0));
    const RenderedLayers layers = renderer.download();
    const RenderCounters counters = renderer.counters();

    RenderSettings path = settings;
    path.pipeline = {};
    path.layers = true;
    ProgressiveStill mean(device(), gpuScene, 8);
    mean.update(camera(scene, path), path);
    while (mean.launch()) continue;
    const RenderedLayers expected = mean.download();
    EXPECT_EQ(layers.samples, 8u);
    EXPECT_EQ(counters.rays, mean.counters().rays);
    EXPECT_EQ(layers.ids, expected.ids);
    for (const auto layer : {&RenderedLayers::diffuse, &RenderedLayers::specular, &RenderedLayers::emission,
                             &RenderedLayers::albedo, &RenderedLayers::normal, &RenderedLayers::depth})
        expectEqual(layers.*layer, expected.*layer, 1e-6f);
}

/// Of each pipeline, each in a frame of several samples: only the very first goes through the centre.
TEST_F(PipelinesTest, EverySampleOfAFrameButTheFirstIsJittered) {
    const Scene scene = prepared(scene::cornellSpheresScene());
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    for (const Pipeline& pipeline : pipelines()) {
        if (pipeline.denoiser && pipeline.denoiser->network) continue;  // cli_kpcn_test.cpp
        RenderSettings settings = settingsFor("path", 24, 16);
        settings.pipeline = pipeline;
        settings.layers = true;
        const auto depths = [&](Jitter jitter, uint32_t samples, uint32_t perLaunch) {
            settings.jitter = jitter;
            settings.samplesPerLaunch = perLaunch;
            FrameRenderer renderer(device(), gpuScene, settings, samples);
            renderer.render(still(scene, settings, 0));
            return renderer.download().depth;
        };
        const std::vector<float> centres = depths(Jitter::Off, 4, 1);
        EXPECT_NE(depths(Jitter::Pixel, 4, 1), centres) << pipeline.name();
        EXPECT_NE(depths(Jitter::Pixel, 4, 2), centres) << pipeline.name();
        const std::vector<float> halton = depths(Jitter::Frame, 4, 1);
        EXPECT_NE(halton, centres) << pipeline.name();
        expectEqual(depths(Jitter::Frame, 4, 3), halton, 1e-5f);  // whatever the launches
        EXPECT_EQ(depths(Jitter::Pixel, 1, 1), depths(Jitter::Off, 1, 1)) << pipeline.name();
    }
}

TEST_F(PipelinesTest, EveryPipelineDrawsFromTheChosenGenerator) {
    const Scene scene = prepared(scene::cornellSpheresScene());
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    for (const Pipeline& pipeline : pipelines()) {
        if (pipeline.denoiser && pipeline.denoiser->network) continue;  // traces as the others that denoise
        if (pipeline.kind == Pipeline::Kind::Preview) continue;         // nothing random after the first hit
        RenderSettings settings =
            settingsFor("path", 24, 16);  // no jitter: of what comes after the first hit
        settings.pipeline = pipeline;
        const auto picture = [&](bool tea) {
            settings.pathtrace.samplerTea = tea;
            FrameRenderer renderer(device(), gpuScene, settings, 1);
            renderer.render(still(scene, settings, 0));
            const RenderedLayers layers = renderer.download();
            return beautyOf(layers).pixels;
        };
        EXPECT_NE(picture(true), picture(false)) << pipeline.name();
        EXPECT_EQ(picture(true), picture(true)) << pipeline.name();
    }
}

TEST_F(PipelinesTest, AccumulationGoesOnUntilAnythingChanges) {
    const Scene scene = prepared(scene::cornellScene());
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    for (const char* pipeline : {"ao", "gbuffer"}) {
        RenderSettings settings = settingsFor(pipeline, 40, 30);
        settings.jitter = Jitter::Pixel;
        FrameRenderer renderer(device(), gpuScene, settings, 2);
        const auto samplesAfter = [&](const Moment& moment) {
            renderer.render(moment);
            return renderer.download().samples;
        };
        Moment moment = still(scene, settings, 0);
        EXPECT_EQ(samplesAfter(moment), 2u);
        EXPECT_EQ(samplesAfter(moment), 4u) << pipeline;
        moment.camera.origin.x += 0.01f;
        EXPECT_EQ(samplesAfter(moment), 2u) << "the camera moved";
        EXPECT_EQ(samplesAfter(moment), 4u);
        assign(settings, pipeline == std::string("ao") ? "ao.radius=0.5" : "gbuffer.shadows=off");
        renderer.setSettings(settings);
        EXPECT_EQ(samplesAfter(moment), 2u) << "another pass's settings changed";
        assign(settings, "atrous.levels=3");
        renderer.setSettings(settings);
        EXPECT_EQ(samplesAfter(moment), 4u) << "what no pass of this pipeline reads";
        settings.extent = {32, 20};
        renderer.setSettings(settings);
        EXPECT_EQ(samplesAfter(moment), 2u) << "the size changed";
        moment.scene.emplace();
        moment.scene->params = gpuScene.params();
        EXPECT_EQ(samplesAfter(moment), 2u) << "something moved";
    }
}

Scene scaled(Scene scene, float scale) {
    for (scene::Mesh& mesh : scene.meshes) {
        for (vec3& p : mesh.positions) p *= scale;
    }
    for (scene::Instance& instance : scene.instances)
        instance.transform[3] = vec4(scale * vec3(instance.transform[3]), 1.0f);
    for (scene::Camera& camera : scene.cameras)
        camera.toWorld[3] = vec4(scale * vec3(camera.toWorld[3]), 1.0f);
    for (scene::PunctualLight& light : scene.lights) {
        light.position *= scale;
        light.intensity *= scale * scale;
    }
    return scene;
}

TEST_F(PipelinesTest, TheScaleOfTheSceneDoesNotMatter) {
    Scene scene = scene::cornellSpheresScene();
    scene::PunctualLight lamp;
    lamp.position = {0.1f, 0.2f, 0.15f};
    lamp.intensity = vec3(0.05f);
    scene.lights.push_back(lamp);
    const Scene plain = prepared(scene);
    for (const char* pipeline : {"history", "atrous"}) {
        const RenderSettings settings = settingsFor(pipeline, 160, 90);
        const std::vector<float> expected = orbit(plain, settings, 10);
        for (const float scale : {0.5f, 1024.0f}) {
            const std::vector<float> picture = orbit(prepared(scaled(scene, scale)), settings, 10);
            std::vector<double> changes;
            for (size_t i = 0; i < picture.size(); i += 4) {
                double change = 0.0;
                for (size_t c = i; c < i + 3; ++c)
                    change = std::max(change, double{std::abs(picture[c] - expected[c])});
                changes.push_back(change);
            }
            std::ranges::sort(changes);
            const auto kept = static_cast<size_t>(0.999 * static_cast<double>(changes.size()));
            double sum = 0.0;
            for (size_t i = 0; i < kept; ++i) sum += changes[i];
            EXPECT_LT(sum / static_cast<double>(kept), 1e-3) << pipeline << " at scale " << scale;
            RecordProperty(std::string(pipeline) + "_change_" + std::to_string(scale),
                           std::to_string(sum / static_cast<double>(kept)));
        }
    }
}

/// What automatic exposure is metered on: without layers too, and after every denoiser.
TEST_F(PipelinesTest, EachTellsWhichPixelsSeeASurface) {
    Scene scene = floorScene(vec3(0.5f));
    scene.cameras = {scene::lookAt({0, 1, 0}, {0, 1, -1}, {0, 1, 0}, 1.0f)};
    scene.environment = {4, 2, std::vector<vec3>(8, vec3(30.0f))};
    const scene::SceneData data = scene::buildSceneData(scene);
    scene::GpuScene gpuScene(device(), data);
    for (const char* pipeline : {"path", "gbuffer", "svgf"}) {
        for (const bool layers : {false, true}) {
            if (layers && std::string_view(pipeline) != "path") continue;
            RenderSettings settings = settingsFor(pipeline, 16, 16);
            settings.layers = layers;
            FrameRenderer renderer(device(), gpuScene, settings, 1);
            for (uint64_t frame = 0; frame < 2; ++frame) renderer.render(still(scene, settings, frame));
            const RenderedLayers pictures = renderer.download();
            const std::vector<float> share = surfaceShare(pictures);
            ASSERT_EQ(share.size(), 256u) << pipeline;
            // The floor ends 10 m away, a little below the horizon.
            for (size_t p = 0; p < share.size(); ++p) {
                if (p / 16 == 8) continue;
                EXPECT_EQ(share[p], p / 16 < 8 ? 0.0f : 1.0f) << pipeline << ", pixel " << p;
            }
            EXPECT_GT(image::autoExposure(beautyOf(pictures), share),
                      image::autoExposure(beautyOf(pictures)) + 0.3f)
                << pipeline;
        }
    }
}

}  // namespace
}  // namespace limpid::test
