// Light that passes surfaces on its way straight to a floor: panes, or partly transparent surfaces.
#pragma once

#include <cmath>

#include "scene/builtin/builtin_parts.h"
#include "scene/lights/environment.h"
#include "tests/gpu/render_fixture.h"

namespace limpid::test {

class PassingLightTest : public RenderTest, public testing::WithParamInterface<scene::Tracer> {
  protected:
    static constexpr float albedo = 0.8f, lampHeight = 3.0f;
    static constexpr gpu::Extent extent{15, 9};

    void SetUp() override {
        GpuTest::SetUp();
        requireTracer(GetParam());
    }

    static void addLayer(scene::Scene& scene, float height, const scene::Material& material) {
        scene::MeshBuilder builder("layer");
        builder.quad({-20, height, 20}, {20, height, 20}, {20, height, -20}, {-20, height, -20});
        addMesh(scene, builder.take(), material);
    }

    static scene::Scene floorSeenFrom(const vec3& eye) {
        scene::Scene scene = floorScene(vec3(albedo));
        scene::addCamera(scene, eye, {0.0f, 0.0f, 0.0f}, 0.5f);
        return scene;
    }
    /// Layers are above the camera.
    static scene::Scene floorBelowLayers() { return floorSeenFrom({0.0f, 0.8f, 2.0f}); }

    static void addLampAndSky(scene::Scene& scene) {
        scene::MeshBuilder lamp("lamp");
        scene::addLamp(lamp, {1.0f, lampHeight, 0.0f}, 1.2f, 1.2f, 0);
        addMesh(scene, lamp.take(), scene::emitter("lamp", vec3(0.5f), vec3(6.0f)));
        scene.environment = scene::softSky();
    }

    static scene::PunctualLight pointLight() {
        scene::PunctualLight light;
        light.position = {0.0f, lampHeight, 0.0f};
        light.intensity = vec3(10.0f);
        return light;
    }

    static scene::PunctualLight sun() {
        scene::PunctualLight light;
        light.kind = scene::PunctualLight::Kind::Directional;
        light.direction = {0.0f, -1.0f, 0.0f};
        light.intensity = vec3(10.0f);
        return light;
    }

    /// Direct light at the centre of the picture, the floor's middle, right below the lamps.
    vec3 lightInTheMiddle(const scene::Scene& scene) {
        const RenderSettings settings = centred(extent.width, extent.height, 1);
        const Rendered picture = Renderer(device(), scene, GetParam())(settings, 64);
        return picture.beauty((extent.height / 2) * extent.width + extent.width / 2);
    }

    struct Estimate {
        double mean = 0.0, error = 0.0;
    };

    /// Of the whole picture's green, from batches of samples, with the feature that lets shadow rays pass, or
    /// without.
    Estimate estimate(const scene::Scene& scene, bool scene::SceneFeatures::*feature, bool pass,
                      int maxDepth) {
        constexpr uint32_t batches = 16, samples = 64;
        scene::SceneData data = scene::buildSceneData(scene);
        EXPECT_TRUE(data.features.*feature);
        data.features.*feature = pass;
        scene::GpuScene placed(device(), data, {GetParam(), {}});
        RenderSettings settings = centred(extent.width, extent.height, 4);
        settings.samplesPerLaunch = 16;
        settings.pathtrace.maxDepth = maxDepth;
        FrameRenderer renderer(device(), placed, settings, UINT64_MAX);
        double sum = 0.0, squares = 0.0;
        for (uint32_t batch = 0; batch < batches; ++batch) {
            settings.seed = 2 * batch + (pass ? 1u : 2u);
            renderer.setSettings(settings);
            renderer.begin({.camera = camera(scene, settings)});
            while (renderer.samplesInMean() < samples) renderer.launch();
            const RenderedLayers layers = renderer.download();
            double mean = 0.0;
            for (size_t p = 0; p < size_t{extent.width} * extent.height; ++p)
                mean += double{layers.beauty[4 * p + 1]} / double{extent.width * extent.height};
            sum += mean / batches;
            squares += mean * mean / batches;
        }
        return {sum, std::sqrt(std::max(squares - sum * sum, 0.0) / (batches - 1))};
    }

    /// Compares the mean with that of paths that meet lamps by chance. The error must be at most `factor` of
    /// theirs.
    void expectTheMeanOfChance(const scene::Scene& scene, bool scene::SceneFeatures::*feature, double factor,
                               int maxDepth = 8) {
        const Estimate by = estimate(scene, feature, false, maxDepth),
                       through = estimate(scene, feature, true, maxDepth);
        fmt::print("mean {:.4f} +- {:.4f}; light that passes {:.4f} +- {:.4f}\n", by.mean, by.error,
                   through.mean, through.error);
        EXPECT_NEAR(through.mean, by.mean, 4.0 * std::hypot(by.error, through.error));
        EXPECT_LT(through.error, factor * by.error);
    }
};

}  // namespace limpid::test
