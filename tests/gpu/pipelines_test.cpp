// Tests properties that whole pipelines must have in any scene.
#include <gmock/gmock.h>

#include <algorithm>

#include "image/metrics/metrics.h"
#include "image/tonemap.h"
#include "renderer/frame/frame_renderer.h"
#include "renderer/method/parameters.h"
#include "renderer/sequence/sequence.h"
#include "scene/builtin/builtin.h"
#include "scene/prepare/prepare.h"
#include "tests/gpu/render_fixture.h"

namespace limpid::test {
namespace {

using scene::Scene;

Scene prepared(Scene scene) {
    scene::prepare(scene);
    return scene;
}

RenderSettings settingsFor(const Pipeline& pipeline, uint32_t width, uint32_t height) {
    RenderSettings settings;
    settings.extent = {width, height};
    settings.pipeline = pipeline;
    settings.jitter = Jitter::Off;
    return settings;
}

class PipelinesTest : public RenderTest {
  protected:
    /// The camera stands still; every frame has independent noise.
    static Moment still(const Scene& scene, const RenderSettings& settings, uint64_t number) {
        Moment moment;
        moment.camera = camera(scene, settings);
        if (number > 0) moment.previousCamera = moment.camera;
        moment.number = number;
        return moment;
    }

    /// Returns the last picture of an orbit of several frames.
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

TEST_F(PipelinesTest, TemporalAccumulationOfAStillCameraIsTheProgressiveMeanOfTheSameSamples) {
    const Scene scene = prepared(scene::cornellSpheresScene());
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    RenderSettings settings = settingsFor(parsePipeline("path", "temporal"), 96, 54);
    assign(settings, "temporal.max_history=0");
    settings.layers = true;  // else they are halves
    constexpr uint64_t frames = 48;
    FrameRenderer renderer(device(), gpuScene, settings, 1);
    for (uint64_t frame = 0; frame < frames; ++frame) renderer.render(still(scene, settings, frame));

    RenderSettings path = settings;
    path.pipeline = {};
    path.layers = true;
    FrameRenderer mean(device(), gpuScene, path, frames);
    mean.render({.camera = camera(scene, path)});
    const image::Image expected = beautyOf(mean.download());
    const image::Image picture = beautyOf(renderer.download());
    for (size_t i = 0; i < expected.pixels.size(); ++i)
        ASSERT_NEAR(picture.pixels[i], expected.pixels[i], 1e-5f * (1.0f + expected.pixels[i])) << i / 3;
}

TEST_F(PipelinesTest, AFrameOfSeveralLaunchesHasTheMeanOfAllItsSamples) {
    const Scene scene = prepared(scene::cornellScene());
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    RenderSettings settings = settingsFor(parsePipeline("path", "temporal"), 48, 27);
    settings.samplesPerLaunch = 3;
    settings.layers = true;
    FrameRenderer renderer(device(), gpuScene, settings, 8);
    renderer.render(still(scene, settings, 0));
    const RenderedLayers layers = renderer.download();
    const RenderCounters counters = renderer.counters();

    RenderSettings path = settings;
    path.pipeline = {};
    path.layers = true;
    FrameRenderer mean(device(), gpuScene, path, 8);
    mean.render({.camera = camera(scene, path)});
    const RenderedLayers expected = mean.download();
    EXPECT_EQ(layers.samples, 8u);
    EXPECT_EQ(counters.rays, mean.counters().rays);
    EXPECT_EQ(layers.ids, expected.ids);
    for (const auto layer : {&RenderedLayers::diffuse, &RenderedLayers::specular, &RenderedLayers::emission,
                             &RenderedLayers::albedo, &RenderedLayers::normal, &RenderedLayers::depth})
        expectEqual(layers.*layer, expected.*layer, 1e-6f);
}

/// The denoiser's input adds up to the integrator's picture, with the guides of the first hit.
TEST_F(PipelinesTest, ADenoiserIsGivenTheAmbientOcclusionOfTheFrame) {
    Scene scene = floorScene(vec3(0.3f));
    scene::MeshBuilder wall("wall");
    wall.quad({-2, 0, -3}, {2, 0, -3}, {2, 1.5f, -3}, {-2, 1.5f, -3});
    addMesh(scene, wall.take(), lambertian(vec3(0.9f)));
    scene.cameras = {scene::lookAt({0, 1, 2}, {0, 1, -3}, {0, 1, 0}, 1.0f)};
    scene = prepared(scene);
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    for (const int rays : {3, 40}) {  // in one dispatch and in several
        for (const uint32_t samples : {1u, 5u}) {
            RenderSettings settings = settingsFor(parsePipeline("ao", "svgf"), 32, 24);
            settings.ambientOcclusion.rays = rays;
            settings.jitter = Jitter::Pixel;
            settings.layers = true;
            FrameRenderer denoised(device(), gpuScene, settings, samples);
            denoised.render(still(scene, settings, 0));
            const RenderedLayers given = denoised.download();
            settings.pipeline.denoiser = nullptr;
            FrameRenderer alone(device(), gpuScene, settings, samples);
            alone.render(still(scene, settings, 0));
            const RenderedLayers expected = alone.download();
            std::vector<float> sum = given.diffuse;
            size_t misses = 0;
            for (size_t i = 0; i < sum.size(); ++i) {
                sum[i] += given.emission[i] + given.specular[i];
                misses += given.emission[i] > 0.0f ? 1 : 0;
                if (i % 4 < 3) {
                    EXPECT_NEAR(given.albedo[i], given.depth[i - i % 4 + 1], 1e-6f);
                }
            }
            EXPECT_GT(misses, 100u);
            expectEqual(sum, expected.beauty, 1e-6f);
            EXPECT_EQ(given.ids, expected.ids);
            for (const auto layer :
                 {&RenderedLayers::normal, &RenderedLayers::depth, &RenderedLayers::motion})
                expectEqual(given.*layer, expected.*layer, 1e-6f);
            EXPECT_EQ(denoised.counters().rays, alone.counters().rays);
        }
    }
}

TEST_F(PipelinesTest, AmbientOcclusionAndDirectLightAreNearerToTheTruthDenoised) {
    const Scene scene = prepared(scene::cornellSpheresScene());
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    for (const char* integrator : {"ao", "direct"}) {
        RenderSettings settings = settingsFor(parsePipeline(integrator), 96, 54);
        settings.samplesPerLaunch = 4;
        settings.seed = 1;
        FrameRenderer mean(device(), gpuScene, settings, 512);
        mean.render({.camera = camera(scene, settings)});
        const image::Image truth = image::displayEncode(beautyOf(mean.download()), 0.0f);
        settings.seed = 2;
        const auto psnrOf = [&](const char* denoiser, uint64_t frames) {
            settings.pipeline = parsePipeline(integrator, denoiser);
            FrameRenderer renderer(device(), gpuScene, settings, 1);
            for (uint64_t frame = 0; frame < frames; ++frame) renderer.render(still(scene, settings, frame));
            return image::psnr(image::displayEncode(beautyOf(renderer.download()), 0.0f), truth);
        };
        const double noisy = psnrOf("none", 1);
        for (const char* denoiser : {"temporal", "svgf"}) {  // the a-trous filter blurs shadows
            const double clean = psnrOf(denoiser, 8);
            fmt::print("{}: {:.2f} dB noisy, {:.2f} after 8 frames of {}\n", integrator, noisy, clean,
                       denoiser);
            EXPECT_GT(clean, noisy + 5.0) << integrator << ", " << denoiser;
        }
    }
}

/// Histories of ambient occlusion belong to one radius; the path tracer does not use it.
TEST_F(PipelinesTest, HistoriesStartAnewWhereTheIntegratorsParametersChange) {
    const Scene scene = prepared(scene::cornellScene());
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    for (const char* integrator : {"ao", "path"}) {
        RenderSettings settings = settingsFor(parsePipeline(integrator, "svgf"), 16, 12);
        FrameRenderer renderer(device(), gpuScene, settings, 1);
        renderer.render(still(scene, settings, 0));
        assign(settings, "ao.radius=0.5");
        EXPECT_EQ(renderer.setSettings(settings), integrator == std::string("ao"));
    }
}

/// For each pipeline, each with several samples per frame: only the very first goes through the centre.
TEST_F(PipelinesTest, EverySampleOfAFrameButTheFirstIsJittered) {
    const Scene scene = prepared(scene::cornellSpheresScene());
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    for (const Pipeline& pipeline : pipelines()) {
        if (pipeline.usesNetwork()) continue;  // cli_kpcn_test.cpp
        RenderSettings settings = settingsFor(pipeline, 24, 16);
        settings.layers = true;
        const auto depths = [&](Jitter jitter, uint32_t samples, uint32_t perLaunch) {
            settings.jitter = jitter;
            settings.samplesPerLaunch = perLaunch;
            FrameRenderer renderer(device(), gpuScene, settings, samples);
            renderer.render(still(scene, settings, 0));
            return renderer.download().depth;
        };
        const std::vector<float> centres = depths(Jitter::Off, 4, 1);
        EXPECT_NE(depths(Jitter::Pixel, 4, 1), centres) << pipeline.title();
        EXPECT_NE(depths(Jitter::Pixel, 4, 2), centres) << pipeline.title();
        const std::vector<float> halton = depths(Jitter::Frame, 4, 1);
        EXPECT_NE(halton, centres) << pipeline.title();
        expectEqual(depths(Jitter::Frame, 4, 3), halton, 1e-5f);  // whatever the launches
        EXPECT_EQ(depths(Jitter::Pixel, 1, 1), depths(Jitter::Off, 1, 1)) << pipeline.title();
    }
}

/// A camera whose axis is turned by the offset looks through the jittered points without jitter.
TEST_F(PipelinesTest, RaysOfAJitteredFrameGoThroughTheFramesPoint) {
    const Scene scene = prepared(scene::cornellSpheresScene());
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    RenderSettings settings = settingsFor(parsePipeline("path", "temporal"), 24, 16);
    settings.layers = true;
    const auto depthOf = [&](Moment moment, Jitter jitter) {
        settings.jitter = jitter;
        FrameRenderer renderer(device(), gpuScene, settings, 1);
        renderer.render(std::move(moment));
        return renderer.download().depth;
    };
    EXPECT_EQ(framePoint(0, 0.5f), vec2(0.0f));
    for (const uint32_t frame : {1u, 2u, 7u}) {
        const Moment jittered = still(scene, settings, frame);
        Moment turned = jittered;
        const vec2 offset = framePoint(frame, 0.5f);
        EXPECT_LE(std::max(std::abs(offset.x), std::abs(offset.y)), 0.25f);
        turned.camera.forward +=
            2.0f / 24.0f * offset.x * jittered.camera.right - 2.0f / 16.0f * offset.y * jittered.camera.up;
        const std::vector<float> expected = depthOf(turned, Jitter::Off);
        EXPECT_NE(depthOf(jittered, Jitter::Off), expected);
        expectEqual(depthOf(jittered, Jitter::Frame), expected, 1e-3f);
    }
}

TEST_F(PipelinesTest, EveryPipelineDrawsFromTheChosenGenerator) {
    const Scene scene = prepared(scene::cornellSpheresScene());
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    for (const Pipeline& pipeline : pipelines()) {
        if (pipeline.usesNetwork()) continue;                      // traces like other denoisers
        if (pipeline.integrator == Integrator::Preview) continue;  // no random numbers after the first hit
        // No jitter, so that only random numbers after the first hit matter.
        RenderSettings settings = settingsFor(pipeline, 24, 16);
        const auto picture = [&](Sampler sampler) {
            settings.pathtrace.samplerTea = sampler == Sampler::Tea;
            settings.pathtrace.samplerSobol = sampler == Sampler::Sobol;
            FrameRenderer renderer(device(), gpuScene, settings, 1);
            renderer.render(still(scene, settings, 0));
            const RenderedLayers layers = renderer.download();
            return beautyOf(layers).pixels;
        };
        EXPECT_NE(picture(Sampler::Tea), picture(Sampler::Pcg)) << pipeline.title();
        EXPECT_NE(picture(Sampler::Sobol), picture(Sampler::Pcg)) << pipeline.title();
        EXPECT_EQ(picture(Sampler::Tea), picture(Sampler::Tea)) << pipeline.title();
        EXPECT_EQ(picture(Sampler::Sobol), picture(Sampler::Sobol)) << pipeline.title();
    }
}

/// The points of a sample do not depend on the launches. Nothing else is random here: paths end before
/// roulette.
TEST_F(PipelinesTest, SobolPointsAreThoseOfTheSamplesWhateverTheLaunches) {
    const Scene scene = prepared(scene::cornellScene());
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    RenderSettings settings = settingsFor(parsePipeline("path"), 24, 16);
    settings.jitter = Jitter::Pixel;
    settings.pathtrace.maxDepth = 2;
    const auto picture = [&](Sampler sampler, uint32_t perLaunch, uint64_t perFrame) {
        settings.pathtrace.samplerSobol = sampler == Sampler::Sobol;
        settings.samplesPerLaunch = perLaunch;
        FrameRenderer renderer(device(), gpuScene, settings, perFrame);
        for (uint64_t frame = 0; frame < 8 / perFrame; ++frame)
            renderer.render(still(scene, settings, frame));
        return renderer.download().beauty;
    };
    const std::vector<float> known = picture(Sampler::Sobol, 1, 8);
    expectEqual(picture(Sampler::Sobol, 4, 8), known, 1e-4f);
    expectEqual(picture(Sampler::Sobol, 1, 1), known, 1e-4f);  // eight frames
    EXPECT_NE(picture(Sampler::Pcg, 4, 8), picture(Sampler::Pcg, 1, 8));
}

TEST_F(PipelinesTest, AccumulationGoesOnUntilAnythingChanges) {
    const Scene scene = prepared(scene::cornellScene());
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    for (const char* pipeline : {"ao", "gbuffer"}) {
        RenderSettings settings = settingsFor(parsePipeline(pipeline), 40, 30);
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

/// Unlike frames of render(), which continue the mean of a picture in which nothing changes.
TEST_F(PipelinesTest, AFrameThatIsBegunContinuesNothing) {
    const Scene scene = prepared(scene::cornellScene());
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    for (const char* denoiser : {"none", "temporal"}) {
        RenderSettings settings = settingsFor(parsePipeline("path", denoiser), 24, 16);
        settings.samplesPerLaunch = 2;
        FrameRenderer once(device(), gpuScene, settings, 5), renderer(device(), gpuScene, settings, 5);
        once.render(still(scene, settings, 3));
        const RenderedLayers expected = once.download();
        renderer.render(still(scene, settings, 0));
        renderer.begin(still(scene, settings, 3));
        EXPECT_THROW(renderer.download(), Error) << "nothing of the frame has been launched";
        int launches = 0;
        while (renderer.launch()) ++launches;
        EXPECT_EQ(launches, settings.pipeline.accumulates() ? 3 : 1);
        EXPECT_EQ(renderer.download().samples, 5u);
        EXPECT_EQ(renderer.download().beauty, expected.beauty) << denoiser;
        EXPECT_EQ(renderer.download().ids, expected.ids);
        renderer.render(still(scene, settings, 4));
        FrameRenderer alone(device(), gpuScene, settings, 5);
        alone.render(still(scene, settings, 4));
        EXPECT_NE(renderer.download().beauty, alone.download().beauty) << denoiser << " has more samples";
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
    for (const char* denoiser : {"temporal", "atrous"}) {
        const RenderSettings settings = settingsFor(parsePipeline("path", denoiser), 160, 90);
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
            EXPECT_LT(sum / static_cast<double>(kept), 1e-3) << denoiser << " at scale " << scale;
            RecordProperty(std::string(denoiser) + "_change_" + std::to_string(scale),
                           std::to_string(sum / static_cast<double>(kept)));
        }
    }
}

/// The input of automatic exposure: available without layers too, and after every denoiser.
TEST_F(PipelinesTest, EachTellsWhichPixelsSeeASurface) {
    Scene scene = floorScene(vec3(0.5f));
    scene.cameras = {scene::lookAt({0, 1, 0}, {0, 1, -1}, {0, 1, 0}, 1.0f)};
    scene.environment = {4, 2, std::vector<vec3>(8, vec3(30.0f))};
    const scene::SceneData data = scene::buildSceneData(scene);
    scene::GpuScene gpuScene(device(), data);
    for (const Pipeline& pipeline :
         {parsePipeline("path"), parsePipeline("gbuffer"), parsePipeline("path", "svgf")}) {
        for (const bool layers : {false, true}) {
            if (layers && pipeline != Pipeline{}) continue;
            RenderSettings settings = settingsFor(pipeline, 16, 16);
            settings.layers = layers;
            FrameRenderer renderer(device(), gpuScene, settings, 1);
            for (uint64_t frame = 0; frame < 2; ++frame) renderer.render(still(scene, settings, frame));
            const RenderedLayers pictures = renderer.download();
            const std::vector<float> share = surfaceShare(pictures);
            ASSERT_EQ(share.size(), 256u) << pipeline.title();
            // The floor ends 10 m away, a little below the horizon.
            for (size_t p = 0; p < share.size(); ++p) {
                if (p / 16 == 8) continue;
                EXPECT_EQ(share[p], p / 16 < 8 ? 0.0f : 1.0f) << pipeline.title() << ", pixel " << p;
            }
            EXPECT_GT(image::autoExposure(beautyOf(pictures), share),
                      image::autoExposure(beautyOf(pictures)) + 0.3f)
                << pipeline.title();
        }
    }
}

}  // namespace
}  // namespace limpid::test
