// Tests KHR_materials_volume: light in absorbing bodies, by Beer's law.
#include <algorithm>
#include <numbers>

#include "tests/gpu/render_fixture.h"

namespace limpid::test {
namespace {

constexpr double pi64 = std::numbers::pi;
const vec3 absorption(0.3f, 1.0f, 2.5f);
/// offsetRay() starts a ray 2^-17 of the largest coordinate (1 here) behind the surface, and that distance
/// absorbs nothing: at most two such offsets, times the strongest absorption, plus float rounding.
const double offsetTolerance = 2.0 * 0x1p-17 * 2.5 + 2e-6;

scene::Material bodyMaterial(float ior, const vec3& sigma) {
    scene::Material material;
    material.metallic = material.roughness = 0.0f;
    material.transmission = 1.0f;
    material.thin = false;
    material.ior = ior;
    material.absorption = sigma;
    return material;
}

void addBox(scene::Scene& scene, const vec3& lower, const vec3& upper, const scene::Material& material) {
    addMesh(scene, scene::MeshBuilder("box").box(lower, upper).take(), material);
}

scene::Material emitting(float radiance) {
    scene::Material material = lambertian(vec3(0.0f));
    material.emission = vec3(radiance);
    return material;
}

/// Looks along -Z from z = 5, at the middle 0.2 of the scene.
scene::Camera parallelCamera() {
    scene::Camera camera = scene::lookAt({0.01f, 0.02f, 5}, {0.01f, 0.02f, 0}, {0, 1, 0}, 0.5f);
    camera.orthographic = true;
    camera.halfHeight = 0.1f;
    return camera;
}

void addWhiteSky(scene::Scene& scene) {
    scene.environment = {16, 8, std::vector<vec3>(128, vec3(1.0f))};
}

class VolumeTest : public RenderTest {
  protected:
    static RenderSettings settings(int maxDepth, uint32_t samplesPerLaunch = 1) {
        RenderSettings settings = centred(16, 16, maxDepth);
        settings.samplesPerLaunch = samplesPerLaunch;
        settings.pathtrace.rouletteDepth = 1024;
        return settings;
    }

    /// Expects every pixel within `tolerance` of `expected`, relative.
    static void expectEverywhere(const Rendered& picture, const dvec3& expected, double tolerance,
                                 const char* name) {
        dvec3 mean(0.0);
        for (size_t i = 0; i < picture.pixelCount(); ++i) {
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(picture.beauty(i)[c] / expected[c], 1.0, tolerance)
                    << name << ", pixel " << i << " channel " << c;
            mean += dvec3(picture.beauty(i)) / static_cast<double>(picture.pixelCount());
        }
        fmt::print("{}: {:.6f} {:.6f} {:.6f}, exactly {:.6f} {:.6f} {:.6f}\n", name, mean.x, mean.y, mean.z,
                   expected.x, expected.y, expected.z);
    }
};

TEST_F(VolumeTest, BodyOfIndexOne) {
    scene::Scene scene;
    addBox(scene, {-1, -1, -0.4f}, {1, 1, 0.9f}, bodyMaterial(1.0f, absorption));
    addWhiteSky(scene);
    scene.cameras = {parallelCamera()};
    ASSERT_TRUE(scene::buildSceneData(scene).features.volume);
    expectEverywhere(render(scene, settings(4), 1), glm::exp(-1.3 * dvec3(absorption)), offsetTolerance,
                     "1.3 m at right angles");
    // At an angle, the distance through the body is longer by the cosine.
    scene.cameras = {scene::lookAt({0.5f, 0.3f, 5}, {0, 0, 0.25f}, {0, 1, 0}, 0.05f)};
    const Rendered picture = render(scene, settings(4), 1);
    const CameraParams view = camera(scene, settings(4));
    for (uint32_t i = 0; i < 256; ++i) {
        const double x = 2.0 * (i % 16 + 0.5) / 16 - 1.0, y = 1.0 - 2.0 * (i / 16 + 0.5) / 16;
        const dvec3 d = glm::normalize(dvec3(view.forward) + x * dvec3(view.right) + y * dvec3(view.up));
        const dvec3 expected = glm::exp(dvec3(absorption) * (1.3 / d.z));
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(picture.beauty(i)[c] / expected[c], 1.0, 1e-4) << i;
    }
}

/// At right angles both faces reflect R = ((n - 1) / (n + 1))^2 repeatedly: with a = exp(-sigma d), the slab
/// shows R + (1 - R)^2 R a^2 / (1 - R^2 a^2) of the sky in front of it and (1 - R)^2 a / (1 - R^2 a^2) of the
/// sky behind it.
TEST_F(VolumeTest, SlabOfGlass) {
    for (const float ior : {1.5f, 2.4f}) {
        scene::Scene scene;
        addBox(scene, {-1, -1, -0.3f}, {1, 1, 0.2f}, bodyMaterial(ior, absorption));
        addWhiteSky(scene);
        scene.cameras = {parallelCamera()};
        const double root = (double{ior} - 1.0) / (double{ior} + 1.0), r = root * root;
        const dvec3 a = glm::exp(-0.5 * dvec3(absorption));
        const dvec3 expected = r + (1.0 - r) * (1.0 - r) * (r * a * a + a) / (1.0 - r * r * a * a);
        const Rendered picture = render(scene, settings(40, 64), 2048);
        dvec3 mean(0.0);
        for (size_t i = 0; i < picture.pixelCount(); ++i) mean += dvec3(picture.beauty(i)) / 256.0;
        fmt::print("slab of index {}: {:.5f} {:.5f} {:.5f}, exactly {:.5f} {:.5f} {:.5f}\n", ior, mean.x,
                   mean.y, mean.z, expected.x, expected.y, expected.z);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c] / expected[c], 1.0, 5e-3) << ior;
    }
}

/// A ray that passes the centre of a sphere of radius 1 at distance b travels 2 sqrt(1 - b^2) inside it; with
/// an index n, 2 sqrt(1 - (b / n)^2), and again after each internal reflection, at the same angle. Each hit
/// reflects the same R: with a = exp(-sigma distance), the ball shows R + (1 - R)^2 a / (1 - R a) of a
/// uniform sky.
class BallTest : public VolumeTest {
  protected:
    static dvec3 expectedOf(double b, double ior) {
        const double cosOut = std::sqrt(1.0 - b * b), cosIn = std::sqrt(1.0 - b * b / (ior * ior));
        const double s = (cosOut - ior * cosIn) / (cosOut + ior * cosIn);
        const double p = (ior * cosOut - cosIn) / (ior * cosOut + cosIn);
        const double r = 0.5 * (s * s + p * p);
        const dvec3 a = glm::exp(-2.0 * cosIn * dvec3(absorption));
        return r + (1.0 - r) * (1.0 - r) * a / (1.0 - r * a);
    }

    /// Returns the distance from the axis of the ray through a pixel's centre.
    static double distanceOf(size_t i, double halfHeight) {
        const double x = 2.0 * (static_cast<double>(i % 16) + 0.5) / 16 - 1.0;
        const double y = 2.0 * (static_cast<double>(i / 16) + 0.5) / 16 - 1.0;
        return halfHeight * std::hypot(x, y);
    }

    Rendered ball(float ior, const RenderSettings& options, uint64_t samples) {
        scene::Scene scene;
        addMesh(scene, scene::MeshBuilder("ball", true).sphere(vec3(0.0f), 1.0f, 512, 256).take(),
                bodyMaterial(ior, absorption));
        addWhiteSky(scene);
        scene.cameras = {scene::lookAt({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.5f)};
        scene.cameras[0].orthographic = true;
        scene.cameras[0].halfHeight = halfHeight;
        return render(scene, options, samples);
    }

    static constexpr float halfHeight = 0.85f;
};

TEST_F(BallTest, OfIndexOne) {
    const Rendered picture = ball(1.0f, settings(4), 1);
    int inside = 0;
    double worst = 0.0;
    for (size_t i = 0; i < 256; ++i) {
        const double b = distanceOf(i, double{halfHeight});
        if (b > 0.95 && b < 1.01) continue;  // the facets' edges are visible there
        const dvec3 expected = b < 1.0 ? expectedOf(b, 1.0) : dvec3(1.0);
        for (int c = 0; c < 3; ++c) {
            worst = std::max(worst, std::abs(picture.beauty(i)[c] / expected[c] - 1.0));
            ASSERT_NEAR(picture.beauty(i)[c] / expected[c], 1.0, 1e-3) << i << " at " << b;
        }
        inside += b < 1.0 ? 1 : 0;
    }
    EXPECT_GT(inside, 150);
    fmt::print("ball of index 1: {} rays within {:.2g}\n", inside, worst);
}

TEST_F(BallTest, OfGlass) {
    const Rendered picture = ball(1.5f, settings(40, 64), 2048);
    dvec3 sum(0.0), expectedSum(0.0);
    for (size_t i = 0; i < 256; ++i) {
        const double b = distanceOf(i, double{halfHeight});
        if (b > 0.95) continue;
        const dvec3 expected = expectedOf(b, 1.5);
        // Each of 2048 samples is between 0 and 1, so their mean is within 5 / (2 sqrt(2048)).
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(picture.beauty(i)[c], expected[c], 0.055) << i << " at " << b;
        sum += dvec3(picture.beauty(i));
        expectedSum += expected;
    }
    fmt::print("ball of glass: {:.4f} {:.4f} {:.4f}, exactly {:.4f} {:.4f} {:.4f}\n", sum.x, sum.y, sum.z,
               expectedSum.x, expectedSum.y, expectedSum.z);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / expectedSum[c], 1.0, 5e-3);
}

TEST_F(VolumeTest, ThinWallsAbsorbNothing) {
    scene::Scene scene;
    scene::Material wall = bodyMaterial(1.5f, absorption);
    wall.thin = true;
    addBox(scene, {-1, -1, -0.4f}, {1, 1, 0.9f}, wall);
    addWhiteSky(scene);
    scene.cameras = {parallelCamera()};
    EXPECT_FALSE(scene::buildSceneData(scene).features.volume);
    // With another body beside it, so that the shader supports absorption.
    addBox(scene, {3, 3, 0}, {4, 4, 1}, bodyMaterial(1.0f, absorption));
    ASSERT_TRUE(scene::buildSceneData(scene).features.volume);
    expectEverywhere(render(scene, settings(20, 64), 1024), dvec3(1.0), 0.02, "thin walls");
}

/// An object inside a body is seen through the part of the body in front of it.
TEST_F(VolumeTest, EmitterInABody) {
    scene::Scene scene;
    addBox(scene, {-1, -1, -1}, {1, 1, 1}, bodyMaterial(1.0f, absorption));
    addMesh(scene,
            scene::MeshBuilder("emitter")
                .quad({-1, -1, 0.25f}, {1, -1, 0.25f}, {1, 1, 0.25f}, {-1, 1, 0.25f})
                .take(),
            emitting(5.0f));
    scene.cameras = {parallelCamera()};
    expectEverywhere(render(scene, settings(3), 1), 5.0 * glm::exp(-0.75 * dvec3(absorption)),
                     offsetTolerance, "emitter in a body");
}

/// A clear body in an absorbing one, like a bubble in glass: absorption excludes the distance inside the
/// clear body, but includes that behind it.
TEST_F(VolumeTest, BodyInABody) {
    scene::Scene scene;
    addBox(scene, {-1, -1, -1}, {1, 1, 1}, bodyMaterial(1.0f, absorption));
    addBox(scene, {-0.8f, -0.8f, -0.1f}, {0.8f, 0.8f, 0.4f}, bodyMaterial(1.0f, vec3(0.0f)));
    addWhiteSky(scene);
    scene.cameras = {parallelCamera()};
    expectEverywhere(render(scene, settings(6), 1), glm::exp(-1.5 * dvec3(absorption)), offsetTolerance,
                     "bubble");
}

/// Finds a light inside a body in both ways; the floor's light is computed by quadrature.
TEST_F(VolumeTest, LightAndFloorInABody) {
    constexpr float sigma = 0.4f, height = 1.1f, half = 0.3f;
    scene::Scene scene = floorScene(vec3(0.6f));
    addBox(scene, {-3, -0.5f, -3}, {3, 2, 3}, bodyMaterial(1.0f, vec3(sigma)));
    addMesh(
        scene,
        scene::MeshBuilder("light")
            .quad({-half, height, -half}, {half, height, -half}, {half, height, half}, {-half, height, half})
            .take(),
        emitting(8.0f));
    scene.cameras = {scene::lookAt({0.2f, 0.8f, 5}, {0, 0, 0}, {0, 1, 0}, 0.12f)};
    RenderSettings options = settings(2, 64);
    options.extent = {8, 8};
    const Rendered picture = render(scene, options, 4096);
    const CameraParams view = camera(scene, options);
    double sum = 0.0, expectedSum = 0.0;
    for (uint32_t i = 0; i < 64; ++i) {
        const dvec3 point = floorPoint(view, options.extent, i % 8, i / 8);
        const dvec3 way = dvec3(view.origin) - point;
        ASSERT_LT(std::abs(point.z), 2.9);
        const double inside = glm::length(way) * (3.0 - point.z) / way.z;
        double irradiance = 0.0;
        constexpr int steps = 64;
        for (int k = 0; k < steps * steps; ++k) {
            const double size = 2.0 * half / steps;
            const dvec3 from((k % steps + 0.5) * size - half, double{height},
                             (k / steps + 0.5) * size - half);
            const dvec3 d = from - point;
            const double d2 = glm::dot(d, d);
            irradiance += 8.0 * std::exp(-sigma * std::sqrt(d2)) * (d.y * d.y / d2) / d2 * size * size;
        }
        const double expected = double{0.6f} / pi64 * irradiance * std::exp(-sigma * inside);
        const double found = double{picture.beauty(i).r};
        ASSERT_NEAR(found / expected, 1.0, 0.05) << i;
        sum += found;
        expectedSum += expected;
    }
    fmt::print("floor and light in a body: {:.6f}, exactly {:.6f}\n", sum, expectedSum);
    EXPECT_NEAR(sum / expectedSum, 1.0, 5e-3);
}

/// Clear glass in front of a white sky is white up to its rim with default settings. At the rim, light is
/// reflected internally more often than a path may bounce.
TEST_F(VolumeTest, TheRimOfGlassIsWhite) {
    const auto columns = [&](bool thin, const RenderSettings& options) {
        scene::Scene scene;
        scene::Material glass = bodyMaterial(1.5f, vec3(0.0f));
        glass.thin = thin;
        addMesh(scene, scene::MeshBuilder("ball", true).sphere(vec3(0.0f), 1.0f, 512, 256).take(), glass);
        addWhiteSky(scene);
        // Columns are distances from the axis, from 0.92 to 1.
        scene.cameras = {scene::lookAt({0.96f, 0, 5}, {0.96f, 0, 0}, {0, 1, 0}, 0.5f)};
        scene.cameras[0].orthographic = true;
        scene.cameras[0].halfHeight = 0.04f;
        const Rendered picture = render(scene, options, 512);
        std::vector<double> means(16, 0.0);
        for (size_t i = 0; i < 256; ++i) means[i % 16] += double{picture.beauty(i).g} / 16.0;
        return means;
    };
    RenderSettings options;
    options.extent = {16, 16};
    options.samplesPerLaunch = 64;
    for (const bool thin : {false, true}) {
        for (const double mean : columns(thin, options))
            EXPECT_NEAR(mean, 1.0, 0.015) << (thin ? "thin" : "solid");
    }
    options.pathtrace.maxTransmissionDepth = 0;
    const std::vector<double> black = columns(false, options);
    fmt::print("with one limit for all bounces the rim is at {:.4f}\n",
               *std::min_element(black.begin(), black.end()));
    EXPECT_LT(*std::min_element(black.begin(), black.end()), 0.98) << "the test would prove little";
}

}  // namespace
}  // namespace limpid::test
