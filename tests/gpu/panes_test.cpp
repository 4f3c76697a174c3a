// Light through smooth panes: shadow rays pass them, with the share that a formula gives; and the mean is
// that of paths that meet lamps behind panes by chance.
#include <cmath>

#include "scene/builtin/builtin_parts.h"
#include "scene/model/environment.h"
#include "tests/gpu/render_fixture.h"

namespace limpid::test {
namespace {

constexpr float albedo = 0.8f, lampHeight = 3.0f;

scene::Material paneMaterial(const vec3& color, float transmission = 1.0f, float roughness = 0.0f) {
    scene::Material material;
    material.name = "pane";
    material.baseColor = vec4(color, 1.0f);
    material.metallic = 0.0f;
    material.roughness = roughness;
    material.transmission = transmission;
    material.doubleSided = true;
    return material;
}

void addPane(scene::Scene& scene, float height, const scene::Material& material) {
    scene::MeshBuilder builder("pane");
    builder.quad({-20, height, 20}, {20, height, 20}, {20, height, -20}, {-20, height, -20});
    addMesh(scene, builder.take(), material);
}

/// A floor, seen from below where panes are.
scene::Scene floorBelowPanes() {
    scene::Scene scene = floorScene(vec3(albedo));
    scene::addCamera(scene, {0.0f, 0.8f, 2.0f}, {0.0f, 0.0f, 0.0f}, 0.5f);
    return scene;
}

scene::PunctualLight pointLight() {
    scene::PunctualLight light;
    light.position = {0.0f, lampHeight, 0.0f};
    light.intensity = vec3(10.0f);
    return light;
}

scene::PunctualLight sun() {
    scene::PunctualLight light;
    light.kind = scene::PunctualLight::Kind::Directional;
    light.direction = {0.0f, -1.0f, 0.0f};
    light.intensity = vec3(10.0f);
    return light;
}

class PanesTest : public RenderTest, public testing::WithParamInterface<scene::Tracer> {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        requireTracer(GetParam());
    }

    static constexpr gpu::Extent extent{15, 9};

    /// Direct light at the centre of the picture, the floor's middle, right below the lamps.
    vec3 lightInTheMiddle(const scene::Scene& scene) {
        const RenderSettings settings = centred(extent.width, extent.height, 1);
        const Rendered picture = Renderer(device(), scene, GetParam())(settings, 64);
        return picture.beauty((extent.height / 2) * extent.width + extent.width / 2);
    }

    struct Estimate {
        double mean = 0.0, error = 0.0;
    };

    /// Of the whole picture's green, from batches of samples; with panes that shadow rays pass, or that they
    /// do not.
    Estimate estimate(const scene::Scene& scene, bool pass) {
        constexpr uint32_t batches = 16, samples = 64;
        scene::SceneData data = scene::buildSceneData(scene);
        EXPECT_TRUE(data.features.panes);
        data.features.panes = pass;
        scene::GpuScene placed(device(), data, {GetParam(), {}});
        RenderSettings settings = centred(extent.width, extent.height, 4);
        settings.samplesPerLaunch = 16;
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
};

/// At right angles a pane of index 1.5 reflects 4 %, and tints the rest.
TEST_P(PanesTest, LampsShineThroughThemByTheFormula) {
    const vec3 color(0.9f, 0.5f, 0.2f);
    for (const bool isSun : {false, true}) {
        const double distance2 = isSun ? 1.0 : std::pow(double{lampHeight}, 2);
        for (const int panes : {0, 1, 3}) {
            scene::Scene scene = floorBelowPanes();
            scene.lights = {isSun ? sun() : pointLight()};
            for (int i = 0; i < panes; ++i)
                addPane(scene, 1.0f + 0.3f * static_cast<float>(i), paneMaterial(color));
            const vec3 light = lightInTheMiddle(scene);
            for (int c = 0; c < 3; ++c) {
                const double share = std::pow(0.96 * double{color[c]}, panes);
                const double expected = double{albedo} / double{pi} * 10.0 / distance2 * share;
                EXPECT_NEAR(double{light[c]} / expected, 1.0, 0.005)
                    << panes << " panes, channel " << c << (isSun ? ", sun" : ", point light");
            }
        }
    }
}

TEST_P(PanesTest, NeitherWallsNorRoughPanesLetShadowRaysPass) {
    for (const scene::Material& material : {lambertian(vec3(0.5f)), paneMaterial(vec3(1.0f), 1.0f, 0.4f)}) {
        scene::Scene scene = floorBelowPanes();
        scene.lights = {pointLight()};
        addPane(scene, 1.0f, paneMaterial(vec3(1.0f)));
        addPane(scene, 1.5f, material);
        EXPECT_EQ(lightInTheMiddle(scene), vec3(0.0f));
    }
}

/// Of a lamp and a sky behind a clear and a clouded pane, at angles up to grazing ones.
TEST_P(PanesTest, TheMeanIsThatOfPathsThatMeetLampsByChance) {
    scene::Scene scene = floorBelowPanes();
    addPane(scene, 1.0f, paneMaterial({0.8f, 0.9f, 1.0f}));
    addPane(scene, 1.3f, paneMaterial({1.0f, 0.7f, 0.5f}, 0.85f));
    scene::MeshBuilder lamp("lamp");
    scene::addLamp(lamp, {1.0f, lampHeight, 0.0f}, 1.2f, 1.2f, 0);
    addMesh(scene, lamp.take(), scene::emitter("lamp", vec3(0.5f), vec3(6.0f)));
    scene.environment = scene::softSky();
    const Estimate by = estimate(scene, false), through = estimate(scene, true);
    fmt::print("mean {:.4f} +- {:.4f}; through panes {:.4f} +- {:.4f}\n", by.mean, by.error, through.mean,
               through.error);
    EXPECT_NEAR(through.mean, by.mean, 4.0 * std::hypot(by.error, through.error));
    EXPECT_LT(through.error, 0.5 * by.error);
}

INSTANTIATE_TEST_SUITE_P(Tracers, PanesTest, testing::Values(scene::Tracer::Compute, scene::Tracer::Hardware),
                         [](const auto& listed) { return std::string(scene::toString(listed.param)); });

}  // namespace
}  // namespace limpid::test
