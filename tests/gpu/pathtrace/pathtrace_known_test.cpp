// Tests pictures in which every pixel is known.
#include <numbers>

#include "scene/builtin/builtin.h"
#include "tests/gpu/render_fixture.h"

namespace limpid::test {
namespace {

constexpr double pi64 = std::numbers::pi;

class KnownAnswerTest : public RenderTest {
  protected:
    static void checkFurnace(Renderer& renderer, float albedo, int depth, int rouletteDepth,
                             Integrator integrator = Integrator::Path) {
        RenderSettings settings;
        settings.pipeline.integrator = integrator;
        settings.extent = {24, 24};
        settings.samplesPerLaunch = 64;
        settings.pathtrace.maxDepth = depth;
        settings.pathtrace.rouletteDepth = rouletteDepth;
        // Long paths are noisy: with 512 samples the mean of one seed deviates by 0.13 %.
        const Rendered picture = renderer(settings, depth > 8 ? 2048 : 512);
        const int bounces = integrator == Integrator::Direct ? std::min(depth, 1) : depth;
        const double expected = (1.0 - std::pow(double{albedo}, bounces + 1)) / (1.0 - double{albedo});
        const std::string how = fmt::format("{}, albedo {} depth {} roulette from {}", nameOf(integrator),
                                            albedo, depth, rouletteDepth);
        const double mean = meanOfRed(picture);
        fmt::print("furnace, {}: {:.5f}, exactly {:.5f} ({:+.3f} %)\n", how, mean, expected,
                   100 * (mean / expected - 1));
        EXPECT_NEAR(mean / expected, 1.0, 3e-3) << how;
        for (size_t i = 0; i < picture.pixelCount(); ++i) {
            ASSERT_NEAR(double{picture.beauty(i).g} / expected, 1.0, 0.25) << how << ", pixel " << i;
        }
        EXPECT_EQ(picture.counters.rejected, 0u);
    }

    /// Compares every pixel that sees the floor with `radiance` of the point there. `tolerance` is per pixel.
    void checkFloor(const scene::Scene& scene, const RenderSettings& settings, uint64_t samples,
                    double tolerance, const std::function<double(const dvec3&)>& radiance,
                    const std::string& name) {
        const Rendered picture = render(scene, settings, samples);
        const CameraParams view = camera(scene, settings);
        double sum = 0.0, expectedSum = 0.0, worst = 0.0;
        for (uint32_t y = 0; y < settings.extent.height; ++y) {
            for (uint32_t x = 0; x < settings.extent.width; ++x) {
                const dvec3 point = floorPoint(view, settings.extent, x, y);
                const double expected = radiance(point),
                             found = double{picture.beauty(y * settings.extent.width + x).r};
                sum += found;
                expectedSum += expected;
                worst = std::max(worst, std::abs(found - expected) / (expected + 1e-4));
                ASSERT_NEAR(found, expected, tolerance * expected + 1e-6)
                    << name << ", pixel " << x << ' ' << y << ", point " << point.x << ' ' << point.z;
            }
        }
        fmt::print("{}: mean {:.6f}, exactly {:.6f} ({:+.3f} %); a pixel is off by {:.2g} at worst\n", name,
                   sum, expectedSum, 100 * (sum / expectedSum - 1), worst);
        EXPECT_NEAR(sum / expectedSum, 1.0, 5e-3) << name;
    }

    /// The floor seen from the side.
    static scene::Scene viewedFloor() {
        scene::Scene scene = floorScene(vec3(0.6f));
        scene.cameras = {scene::lookAt({0.5f, 4, 4}, {0, 0, 0}, {0, 1, 0}, 0.6f)};
        return scene;
    }
};

TEST_F(KnownAnswerTest, Furnace) {
    for (const float albedo : {0.5f, 0.8f}) {
        Renderer renderer(device(), scene::furnaceScene(albedo));
        for (const int depth : {4, 24}) checkFurnace(renderer, albedo, depth, 3);
        checkFurnace(renderer, albedo, 4, 0);
        checkFurnace(renderer, albedo, 0, 0);
    }
}

/// Emission, and light of one bounce, however many bounces are allowed.
TEST_F(KnownAnswerTest, FurnaceOfDirectLight) {
    Renderer renderer(device(), scene::furnaceScene(0.8f));
    for (const int depth : {0, 1, 8}) checkFurnace(renderer, 0.8f, depth, 3, Integrator::Direct);
}

/// Exactly a point light's illumination, without the light that the floor reflects onto the wall and back.
TEST_F(KnownAnswerTest, DirectLightHasNoSecondBounce) {
    scene::Scene scene = viewedFloor();
    scene::MeshBuilder wall("wall");
    wall.quad({-10, 0, -3.6f}, {10, 0, -3.6f}, {10, 6, -3.6f}, {-10, 6, -3.6f});
    addMesh(scene, wall.take(), lambertian(vec3(0.9f)));
    scene::PunctualLight light;
    light.position = {0.3f, 1.5f, -0.2f};
    light.intensity = vec3(7.0f);
    scene.lights = {light};
    const auto direct = [&](const dvec3& p) {
        const dvec3 d = dvec3(light.position) - p;
        const double d2 = glm::dot(d, d);
        return double{0.6f} / pi64 * 7.0 * d.y / std::sqrt(d2) / d2;
    };
    RenderSettings settings = centred(16, 16, 8);
    const double all = meanOfRed(render(scene, settings, 64));
    settings.pipeline.integrator = Integrator::Direct;
    checkFloor(scene, settings, 1, 5e-3, direct, "direct light");
    EXPECT_GT(all, 1.005 * meanOfRed(render(scene, settings, 1)));
}

TEST_F(KnownAnswerTest, PointLightWithAndWithoutRange) {
    for (const float range : {0.0f, 3.0f}) {
        scene::Scene scene = viewedFloor();
        scene::PunctualLight light;
        light.position = {0.3f, 1.5f, -0.2f};
        light.intensity = vec3(7.0f);
        light.range = range;
        scene.lights = {light};
        checkFloor(
            scene, centred(16, 16, 1), 1, 5e-3,
            [&](const dvec3& p) {
                const dvec3 d = dvec3(light.position) - p;
                const double d2 = glm::dot(d, d);
                const double window =
                    range > 0.0f ? std::clamp(1.0 - d2 * d2 / std::pow(double{range}, 4.0), 0.0, 1.0) : 1.0;
                return double{0.6f} / pi64 * 7.0 * window * d.y / std::sqrt(d2) / d2;
            },
            fmt::format("point light, range {}", range));
    }
}

TEST_F(KnownAnswerTest, SpotLight) {
    scene::Scene scene = viewedFloor();
    scene::PunctualLight light;
    light.kind = scene::PunctualLight::Kind::Spot;
    light.position = {-0.5f, 2.0f, 0.5f};
    light.direction = glm::normalize(vec3(0.3f, -1.0f, -0.2f));
    light.intensity = vec3(12.0f);
    light.innerCone = 0.25f;
    light.outerCone = 0.7f;
    scene.lights = {light};
    checkFloor(
        scene, centred(16, 16, 1), 1, 5e-3,
        [&](const dvec3& p) {
            const dvec3 d = dvec3(light.position) - p;
            const double d2 = glm::dot(d, d);
            const double angle = glm::dot(dvec3(light.direction), -d / std::sqrt(d2));
            const double inner = std::cos(double{light.innerCone}), outer = std::cos(double{light.outerCone});
            const double cone = std::clamp((angle - outer) / (inner - outer), 0.0, 1.0);
            return double{0.6f} / pi64 * 12.0 * cone * cone * d.y / std::sqrt(d2) / d2;
        },
        "spot light");
}

TEST_F(KnownAnswerTest, DirectionalLight) {
    scene::Scene scene = viewedFloor();
    scene::PunctualLight light;
    light.kind = scene::PunctualLight::Kind::Directional;
    light.direction = glm::normalize(vec3(0.4f, -1.0f, 0.3f));
    light.intensity = vec3(3.0f);
    scene.lights = {light};
    const double expected = double{0.6f} / pi64 * 3.0 * -double{light.direction.y};
    checkFloor(
        scene, centred(8, 8, 1), 1, 5e-3, [&](const dvec3&) { return expected; }, "directional light");
}

/// Returns the configuration factor from a surface element to a parallel rectangle: J. R. Howell, "A catalog
/// of radiation heat transfer configuration factors", B-4, for a corner above the element; four of them make
/// any rectangle.
double cornerFactor(double a, double b, double c) {
    const double x = a / c, y = b / c, rx = std::sqrt(1.0 + x * x), ry = std::sqrt(1.0 + y * y);
    return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2.0 * pi64);
}

TEST_F(KnownAnswerTest, EmissiveQuadAboveTheFloor) {
    scene::Scene scene = viewedFloor();
    const double x0 = -0.6, x1 = 0.8, z0 = -0.7, z1 = 0.5, height = 1.1;
    scene::Material light = lambertian(vec3(0.0f));
    light.emission = vec3(5.0f);
    scene::MeshBuilder builder("light");
    builder.quad(vec3(x0, height, z0), vec3(x1, height, z0), vec3(x1, height, z1), vec3(x0, height, z1));
    addMesh(scene, builder.take(), light);
    // From below the light, which would hide the floor from above.
    scene.cameras = {scene::lookAt({0.2f, 0.9f, 1.6f}, {0, 0, -0.2f}, {0, 1, 0}, 0.3f)};
    RenderSettings settings = centred(12, 12, 1);
    settings.samplesPerLaunch = 128;
    checkFloor(
        scene, settings, 4096, 0.05,
        [&](const dvec3& p) {
            const double factor =
                cornerFactor(x1 - p.x, z1 - p.z, height) - cornerFactor(x0 - p.x, z1 - p.z, height) -
                cornerFactor(x1 - p.x, z0 - p.z, height) + cornerFactor(x0 - p.x, z0 - p.z, height);
            return double{0.6f} * 5.0 * factor;
        },
        "emissive quad");
}

/// A convex body under a sky of radiance 1 shows its albedo everywhere.
TEST_F(KnownAnswerTest, ConvexBodyUnderAConstantSky) {
    scene::Scene scene;
    scene::MeshBuilder builder("sphere");
    builder.sphere(vec3(0.0f), 1.0f, 24, 12);
    addMesh(scene, builder.take(), lambertian(vec3(0.7f)));
    scene.environment = {16, 8, std::vector<vec3>(128, vec3(1.0f))};
    scene.cameras = {scene::lookAt({0, 1, 4}, {0, 0, 0}, {0, 1, 0}, 0.7f)};
    RenderSettings settings = centred(24, 24, 4);
    settings.layers = true;
    settings.samplesPerLaunch = 64;
    const Rendered picture = render(scene, settings, 1024);
    double sum = 0.0, count = 0.0;
    for (size_t i = 0; i < picture.pixelCount(); ++i) {
        const double scattered =
            double{picture.layers.diffuse[4 * i]} + double{picture.layers.specular[4 * i]};
        const double emitted = double{picture.layers.emission[4 * i]};
        if (picture.layers.depth[4 * i] == 0.0f) {
            ASSERT_NEAR(emitted, 1.0, 1e-5) << "sky at pixel " << i;
            continue;
        }
        ASSERT_EQ(emitted, 0.0);
        ASSERT_NEAR(scattered, 0.7, 0.12) << "pixel " << i;
        sum += scattered;
        ++count;
    }
    fmt::print("constant sky: {:.5f} over {} pixels, exactly 0.7\n", sum / count, count);
    EXPECT_GT(count, 100);
    EXPECT_NEAR(sum / count, 0.7, 0.7 * 5e-3);
}

}  // namespace
}  // namespace limpid::test
