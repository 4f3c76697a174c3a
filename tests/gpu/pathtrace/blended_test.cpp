// Partly transparent surfaces (BLEND): they weaken the light that passes straight on, with little or no
// noise, and shine as much as they are there.
#include "tests/gpu/pathtrace/passing_light_fixture.h"

namespace limpid::test {
namespace {

using BlendedTest = PassingLightTest;

scene::Material layerOf(float alpha) {
    scene::Material material = lambertian(vec3(0.6f, 0.7f, 0.8f));
    material.alphaMode = scene::AlphaMode::Blend;
    material.baseColor.a = alpha;
    material.doubleSided = true;
    return material;
}

void setAlpha(scene::Material& material, scene::AlphaMode mode, float alpha) {
    material.alphaMode = mode;
    material.baseColor.a = alpha;
}

TEST_P(BlendedTest, LayersWeakenLightByTheFormula) {
    for (const bool isSun : {false, true}) {
        const double distance2 = isSun ? 1.0 : std::pow(double{lampHeight}, 2);
        for (const int layers : {0, 1, 4}) {
            scene::Scene scene = floorBelowLayers();
            scene.lights = {isSun ? sun() : pointLight()};
            for (int i = 0; i < layers; ++i)
                addLayer(scene, 1.0f + 0.3f * static_cast<float>(i), layerOf(0.3f));
            const double expected = double{albedo} / double{pi} * 10.0 / distance2 * std::pow(0.7, layers);
            EXPECT_NEAR(double{lightInTheMiddle(scene).g} / expected, 1.0, 0.001)
                << layers << " layers" << (isSun ? ", sun" : ", point light");
        }
    }
}

TEST_P(BlendedTest, OpaqueAndMaskedSurfacesBehindThemBlockLight) {
    for (const scene::AlphaMode mode : {scene::AlphaMode::Opaque, scene::AlphaMode::Mask}) {
        scene::Scene scene = floorBelowLayers();
        scene.lights = {pointLight()};
        addLayer(scene, 1.0f, layerOf(0.3f));
        addLayer(scene, 1.5f, lambertian(vec3(0.5f)));
        setAlpha(scene.materials.back(), mode, 0.6f);  // the cutoff is 0.5
        EXPECT_EQ(lightInTheMiddle(scene), vec3(0.0f));
    }
}

/// Of a lamp and a sky above more layers than shadow rays pass, seen through some of them.
TEST_P(BlendedTest, TheMeanIsThatOfChance) {
    scene::Scene scene = floorSeenFrom({0.0f, 1.5f, 2.5f});
    for (int i = 0; i < 11; ++i) addLayer(scene, 0.8f + 0.15f * static_cast<float>(i), layerOf(0.12f));
    addLampAndSky(scene);
    expectTheMeanOfChance(scene, &scene::SceneFeatures::blended, 0.85);
}

TEST_P(BlendedTest, LampsShineAsMuchAsTheyAreThere) {
    const auto lightOf = [&](scene::AlphaMode mode, float alpha) {
        scene::Scene scene = floorBelowLayers();
        addLampAndSky(scene);
        scene.environment = {};
        setAlpha(scene.materials.back(), mode, alpha);
        return double{lightInTheMiddle(scene).g};
    };
    const double whole = lightOf(scene::AlphaMode::Opaque, 1.0f);
    EXPECT_GT(whole, 0.0);
    EXPECT_NEAR(lightOf(scene::AlphaMode::Blend, 0.25f) / whole, 0.25, 0.01);
    EXPECT_NEAR(lightOf(scene::AlphaMode::Mask, 0.6f) / whole, 1.0, 0.01);
    EXPECT_EQ(lightOf(scene::AlphaMode::Mask, 0.4f), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Tracers, BlendedTest,
                         testing::Values(scene::Tracer::Compute, scene::Tracer::Hardware),
                         [](const auto& listed) { return std::string(scene::toString(listed.param)); });

}  // namespace
}  // namespace limpid::test
