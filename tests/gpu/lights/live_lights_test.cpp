// Compares lights changed on the device with scenes built with them; and tests the preview, which needs no
// lights.
#include "scene/lights/live_lights.h"

#include <gmock/gmock.h>

#include "renderer/frame/frame_renderer.h"
#include "scene/builtin/builtin.h"
#include "scene/lights/light_control.h"
#include "scene/motion/movement.h"
#include "scene/motion/scene_animator.h"
#include "scene/prepare/prepare.h"
#include "tests/gpu/render_fixture.h"

namespace limpid::test {
namespace {

using scene::LightControl;
using scene::Scene;

class LiveLightsTest : public RenderTest {
  protected:
    static RenderSettings small(const Pipeline& pipeline) {
        RenderSettings settings;
        settings.extent = {24, 16};
        settings.pipeline = pipeline;
        return settings;
    }
    /// The box with its ceiling, a lamp, a sun and an environment.
    static Scene litScene() {
        Scene scene = scene::builtinScene("cornell-moving");
        scene::PunctualLight lamp, sun;
        lamp.position = {0.3f, 0.6f, 0.4f};
        sun.kind = scene::PunctualLight::Kind::Directional;
        scene.lights = {lamp, sun};
        scene.environment.width = 8;
        scene.environment.height = 4;
        for (int i = 0; i < 32; ++i)
            scene.environment.radiance.push_back(
                vec3(0.1f * static_cast<float>(i % 8), 0.3f, 0.01f * static_cast<float>(i)));
        scene::prepare(scene);
        return scene;
    }
    static std::vector<LightControl> changed(std::vector<LightControl> controls) {
        for (LightControl& control : controls) {
            control.brightness = 0.5f;
            control.color *= vec3(1.0f, 0.5f, 2.0f);
            if (control.kind == LightControl::Kind::Environment) control.turn = 77.0f;
        }
        controls.at(0).position += vec3(0.1f);
        controls.at(1).on = false;
        return controls;
    }
    static std::vector<float> picture(FrameRenderer& renderer, const Moment& moment) {
        renderer.render(moment);
        const RenderedLayers layers = renderer.download();
        return beautyOf(layers).pixels;
    }
};

TEST_F(LiveLightsTest, AChangedSceneIsTheSceneBuiltSo) {
    for (const Pipeline& pipeline :
         {parsePipeline("path"), parsePipeline("gbuffer"), parsePipeline("path", "svgf")}) {
        Scene scene = litScene();
        const scene::SceneData data = scene::buildSceneData(scene);
        scene::GpuScene onDevice(device(), data);
        scene::LiveLights live(scene, data);
        const RenderSettings settings = small(pipeline);
        Moment moment;
        moment.camera = camera(scene, settings);
        FrameRenderer renderer(device(), onDevice, settings, 4);
        const std::vector<float> start = picture(renderer, moment);

        const std::vector<LightControl> before = scene::lightControlsOf(scene), after = changed(before);
        const auto change = [&](const std::vector<LightControl>& to, const std::vector<LightControl>& from) {
            scene::applyLightControls(scene, to, from);
            live.update(scene);
            moment.scene.emplace();
            moment.scene->params = onDevice.params();
            live.setParams(moment.scene->params);
            live.addTo(*moment.scene);
        };
        change(after, before);
        FrameRenderer next(device(), onDevice, settings, 4);
        const std::vector<float> relit = picture(next, moment);
        EXPECT_NE(relit, start) << pipeline.title();

        scene::GpuScene anew(device(), scene::buildSceneData(scene));
        Moment still;
        still.camera = moment.camera;
        FrameRenderer other(device(), anew, settings, 4);
        EXPECT_EQ(picture(other, still), relit) << pipeline.title();

        change(before, after);
        FrameRenderer last(device(), onDevice, settings, 4);
        EXPECT_EQ(picture(last, moment), start) << pipeline.title();
    }
}

/// A mean restarts after the change; histories of denoisers continue.
TEST_F(LiveLightsTest, TheMeanStartsAnew) {
    Scene scene = litScene();
    const scene::SceneData data = scene::buildSceneData(scene);
    scene::GpuScene onDevice(device(), data);
    scene::LiveLights live(scene, data);
    const RenderSettings settings = small({});
    FrameRenderer renderer(device(), onDevice, settings, 2);
    Moment moment;
    moment.camera = camera(scene, settings);
    renderer.render(moment);
    renderer.render(moment);
    EXPECT_EQ(renderer.samplesInMean(), 4u);
    live.update(scene);
    moment.scene.emplace();
    moment.scene->params = onDevice.params();
    live.addTo(*moment.scene);
    renderer.render(moment);
    EXPECT_EQ(renderer.samplesInMean(), 2u);
}

/// While a clip plays, in the same frame as the animator's updates.
TEST_F(LiveLightsTest, ChangesWhileThingsMove) {
    Scene scene = litScene();
    scene::chooseClip(scene, "");
    const scene::SceneData data = scene::buildSceneData(scene);
    scene::LiveLights live(scene, data);
    scene::SceneAnimator animator(scene, data);
    const RenderSettings settings = small({});
    const std::vector<LightControl> before = scene::lightControlsOf(scene);
    scene::applyLightControls(scene, changed(before), before);
    live.update(scene);
    animator.setLights(live.packed());
    Moment moment;
    moment.camera = camera(scene, settings);
    moment.scene = animator.frame(1.0, 0.9);
    live.setParams(moment.scene->params);
    live.addTo(*moment.scene);
    scene::GpuScene onDevice(device(), data);
    FrameRenderer renderer(device(), onDevice, settings, 4);
    const std::vector<float> relit = picture(renderer, moment);

    const scene::SceneData dataAnew = scene::buildSceneData(scene);
    scene::GpuScene anew(device(), dataAnew);
    Moment same;
    same.camera = moment.camera;
    same.scene = scene::SceneAnimator(scene, dataAnew).frame(1.0, 0.9);
    FrameRenderer other(device(), anew, settings, 4);
    EXPECT_EQ(picture(other, same), relit);
}

/// A quarter turn of a picture with eight columns equals the picture with its columns shifted by two.
TEST_F(LiveLightsTest, TheEnvironmentTurns) {
    Scene scene = floorScene(vec3(0.5f));
    scene.cameras = {scene::lookAt({0, 2, 5}, {0, 2.5f, 0}, {0, 1, 0}, 1.4f)};
    scene.environment.width = 8;
    scene.environment.height = 2;
    for (int i = 0; i < 16; ++i)
        scene.environment.radiance.push_back(vec3(i % 8 == 1 ? 8.0f : 0.1f * static_cast<float>(i % 8)));
    scene::prepare(scene);
    Scene moved = scene;
    for (size_t i = 0; i < 16; ++i)
        moved.environment.radiance[i / 8 * 8 + (i + 2) % 8] = scene.environment.radiance[i];
    scene.environment.turn = 0.25f;
    RenderSettings settings = centred(24, 16, 2);
    settings.samplesPerLaunch = 32;
    const Rendered turned = render(scene, settings, 256), expected = render(moved, settings, 256);
    double sum = 0.0, sumExpected = 0.0;
    for (size_t i = 0; i < turned.pixelCount(); ++i) {
        const float at = turned.beauty(i).r, there = expected.beauty(i).r;
        const bool sky = i < turned.pixelCount() / 4;  // seen directly
        if (sky) {
            ASSERT_NEAR(at, there, 1e-4f * (1.0f + there)) << i;
        }
        sum += double{at};
        sumExpected += double{there};
    }
    EXPECT_NEAR(sum / sumExpected, 1.0, 0.02);
    scene.environment.turn = 0.0f;
    EXPECT_GT(std::abs(meanOfRed(render(scene, settings, 256)) / meanOfRed(expected) - 1.0), 0.05)
        << "the turn must be seen";
}

TEST_F(LiveLightsTest, ThePreviewShowsColoursWithoutAnyLight) {
    Scene scene = floorScene(vec3(0.5f, 0.25f, 0.125f));
    scene.cameras = {scene::lookAt({0, 4, 0}, {0, 0, 0}, {0, 0, -1}, 0.2f)};
    scene::PunctualLight off;
    off.intensity = vec3(0.0f);
    scene.lights = {off};
    RenderSettings settings = small(parsePipeline("preview"));
    settings.jitter = Jitter::Off;
    scene::GpuScene onDevice(device(), scene::buildSceneData(scene));
    FrameRenderer renderer(device(), onDevice, settings, 1);
    Moment moment;
    moment.camera = camera(scene, settings);
    const std::vector<float> floor = picture(renderer, moment);
    const size_t middle = 3 * (8 * 24 + 12);
    EXPECT_NEAR(floor[middle], 0.5f, 0.005f);
    EXPECT_NEAR(floor[middle + 1], 0.25f, 0.005f);
    EXPECT_NEAR(floor[middle + 2], 0.125f, 0.005f);
    // Beyond the floor's edge is the backdrop, which is not black.
    moment.camera = scene::cameraParams(scene::lookAt({0, 4, 0}, {0, 8, -1}, {0, 1, 0}, 0.2f), 24, 16);
    const std::vector<float> backdrop = picture(renderer, moment);
    EXPECT_GT(backdrop[middle], 0.05f);
    EXPECT_EQ(backdrop[0], backdrop[middle]);
}

}  // namespace
}  // namespace limpid::test
