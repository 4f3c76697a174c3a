// Light through smooth panes: shadow rays pass them, with the share that a formula gives; and the mean is
// that of paths that meet lamps behind panes by chance.
#include "tests/gpu/pathtrace/passing_light_fixture.h"

namespace limpid::test {
namespace {

using PanesTest = PassingLightTest;

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

/// At right angles a pane of index 1.5 reflects 4 %, and tints the rest.
TEST_P(PanesTest, LampsShineThroughThemByTheFormula) {
    const vec3 color(0.9f, 0.5f, 0.2f);
    for (const bool isSun : {false, true}) {
        const double distance2 = isSun ? 1.0 : std::pow(double{lampHeight}, 2);
        for (const int panes : {0, 1, 3}) {
            scene::Scene scene = floorBelowLayers();
            scene.lights = {isSun ? sun() : pointLight()};
            for (int i = 0; i < panes; ++i)
                addLayer(scene, 1.0f + 0.3f * static_cast<float>(i), paneMaterial(color));
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
        scene::Scene scene = floorBelowLayers();
        scene.lights = {pointLight()};
        addLayer(scene, 1.0f, paneMaterial(vec3(1.0f)));
        addLayer(scene, 1.5f, material);
        EXPECT_EQ(lightInTheMiddle(scene), vec3(0.0f));
    }
}

/// Rounding must not make more of it, at any angle.
TEST_P(PanesTest, ACoatThatReflectsEverythingLetsNoLightThrough) {
    scene::Scene scene = floorBelowLayers();
    scene.lights = {pointLight()};
    scene::Material mirror = paneMaterial(vec3(1.0f));
    mirror.specularColor = vec3(30.0f);
    addLayer(scene, 1.0f, mirror);
    const Rendered picture = Renderer(device(), scene, GetParam())(centred(64, 36, 1), 1);
    EXPECT_EQ(picture.counters.rejected, 0u);
    for (size_t p = 0; p < picture.pixelCount(); ++p) ASSERT_NEAR(picture.beauty(p).x, 0.0f, 1e-4f) << p;
}

/// Of a lamp and a sky behind a clear and a clouded pane, at angles up to grazing ones.
TEST_P(PanesTest, TheMeanIsThatOfPathsThatMeetLampsByChance) {
    scene::Scene scene = floorBelowLayers();
    addLayer(scene, 1.0f, paneMaterial({0.8f, 0.9f, 1.0f}));
    addLayer(scene, 1.3f, paneMaterial({1.0f, 0.7f, 0.5f}, 0.85f));
    addLampAndSky(scene);
    expectTheMeanOfChance(scene, &scene::SceneFeatures::panes, 0.5);
}

/// A path passes panes after its last bounce, too.
TEST_P(PanesTest, TheMeanOfASingleBounceIsThatOfChance) {
    scene::Scene scene = floorBelowLayers();
    addLayer(scene, 1.0f, paneMaterial({0.8f, 0.9f, 1.0f}));
    addLampAndSky(scene);
    expectTheMeanOfChance(scene, &scene::SceneFeatures::panes, 0.7, 1);
}

INSTANTIATE_TEST_SUITE_P(Tracers, PanesTest, testing::Values(scene::Tracer::Compute, scene::Tracer::Hardware),
                         [](const auto& listed) { return std::string(scene::toString(listed.param)); });

}  // namespace
}  // namespace limpid::test
