// Tests that choosing a light keeps Sobol' points even: the error of direct light falls much below that of
// independent numbers.
#include "tests/gpu/render_fixture.h"

namespace limpid::test {
namespace {

constexpr uint32_t samples = 64;

class EvenChoiceTest : public RenderTest {
  protected:
    /// Mean squared error of the picture relative to its mean, by two renders with different seeds.
    static double errorOf(Renderer& renderer, bool sobol, bool tree = false) {
        RenderSettings settings = centred(32, 24, 1);
        settings.pathtrace.samplerSobol = sobol;
        settings.pathtrace.lightTree = tree;
        const Rendered a = renderer(settings, samples);
        settings.seed = 1;
        const Rendered b = renderer(settings, samples);
        double error = 0.0, mean = 0.0;
        for (size_t i = 0; i < a.pixelCount(); ++i) {
            const double x = double{a.beauty(i).r}, y = double{b.beauty(i).r};
            error += 0.5 * (x - y) * (x - y);
            mean += 0.5 * (x + y);
        }
        const auto pixels = static_cast<double>(a.pixelCount());
        return error / pixels / ((mean / pixels) * (mean / pixels));
    }

    /// Returns the error with Sobol' points divided by that with independent numbers.
    double gain(scene::Scene scene, bool tree = false) {
        scene.cameras = {scene::lookAt({0, 3, 4}, {0, 0, 0}, {0, 1, 0}, 0.6f)};
        Renderer renderer(device(), scene);
        const double sobol = errorOf(renderer, true, tree), independent = errorOf(renderer, false, tree);
        fmt::print("relative error {:.3g} with Sobol' points, {:.3g} with independent numbers\n", sobol,
                   independent);
        return sobol / independent;
    }
};

/// A sky of 40x24 texels (no power of two) with a soft sun.
TEST_F(EvenChoiceTest, Environment) {
    scene::Scene scene = floorScene(vec3(0.5f));
    scene.environment = {40, 24, {}};
    for (int y = 0; y < 24; ++y) {
        for (int x = 0; x < 40; ++x) {
            const float dx = static_cast<float>(x - 23), dy = static_cast<float>(y - 7);
            scene.environment.radiance.emplace_back(0.3f + 0.02f * static_cast<float>(24 - y) +
                                                    20.0f * std::exp(-0.15f * (dx * dx + dy * dy)));
        }
    }
    EXPECT_LT(gain(scene), 0.15);
}

/// Each direction of a diffuse surface brings the same light, whichever way it was found.
TEST_F(EvenChoiceTest, AnEvenSkyOverAFloorHasNoNoise) {
    scene::Scene scene = floorScene(vec3(0.5f));
    scene.environment = {1, 1, {vec3(1.0f)}};
    scene.cameras = {scene::lookAt({0, 3, 4}, {0, 0, 0}, {0, 1, 0}, 0.6f)};
    Renderer renderer(device(), scene);
    EXPECT_LT(errorOf(renderer, false), 1e-9);
    const Rendered one = renderer(centred(8, 6, 1), 1);
    for (size_t i = 0; i < one.pixelCount(); ++i) EXPECT_NEAR(one.beauty(i).g, 0.5f, 1e-4f);
}

/// Six lamps, and so twelve triangles, of very different power.
TEST_F(EvenChoiceTest, LampsOfDifferentPower) {
    scene::Scene scene = floorScene(vec3(0.5f));
    for (int i = 0; i < 6; ++i) {
        scene::MeshBuilder builder("lamp");
        const float x = -2.0f + 0.8f * static_cast<float>(i), side = 0.1f + 0.05f * static_cast<float>(i % 3);
        builder.quad({x, 2, -side}, {x + side, 2, -side}, {x + side, 2, 0}, {x, 2, 0});
        scene::Material material = lambertian(vec3(0.0f));
        material.emission = vec3(2.0f + 30.0f * static_cast<float>((i * 3) % 5));
        material.doubleSided = true;
        addMesh(scene, builder.take(), material);
    }
    EXPECT_LT(gain(scene), 0.1);
    EXPECT_LT(gain(scene, true), 0.1) << "by the light tree";
}

}  // namespace
}  // namespace limpid::test
