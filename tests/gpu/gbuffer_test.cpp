// Compares the G-buffer with the path tracer's layers, and its light with known answers.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "passes/deform/deform.h"
#include "renderer/sequence/sequence.h"
#include "scene/builtin/builtin.h"
#include "scene/motion/movement.h"
#include "tests/gpu/pass_fixture.h"
#include "tests/reference/moving_scenes.h"
#include "tests/reference/rng_copy.h"

namespace limpid::test {
namespace {

constexpr double pi64 = std::numbers::pi;
constexpr gpu::Extent extent{96, 54};

scene::PunctualLight pointLight(const vec3& position, float intensity) {
    scene::PunctualLight light;
    light.position = position;
    light.intensity = vec3(intensity);
    return light;
}

/// The floor seen from the side.
scene::Scene viewedFloor() {
    scene::Scene scene = floorScene(vec3(0.6f));
    scene.cameras = {scene::lookAt({0.5f, 4, 4}, {0, 0, 0}, {0, 1, 0}, 0.6f)};
    return scene;
}

/// A square of side 0.8 that floats in the plane y = 0.7.
void addScreen(scene::Scene& scene) {
    scene::MeshBuilder builder("screen");
    builder.quad({-0.4f, 0.7f, 0.4f}, {0.4f, 0.7f, 0.4f}, {0.4f, 0.7f, -0.4f}, {-0.4f, 0.7f, -0.4f});
    addMesh(scene, builder.take(), lambertian(vec3(0.5f)));
}

/// The spheres below clear coats, with rough, absorbing glass, and lamps that only next-event estimation
/// finds.
scene::Scene punctualSpheres() {
    scene::Scene scene = scene::cornellSpheresScene();
    for (scene::Material& material : scene.materials) {
        material.emission = vec3(0.0f);
        material.clearcoat = 0.5f;
        material.clearcoatRoughness = 0.3f;
        if (material.thin) continue;
        material.roughness = 0.3f;
        material.absorption = vec3(2.0f, 8.0f, 20.0f);
    }
    scene.lights = {pointLight({0.1f, 0.5f, 0.2f}, 1.0f), pointLight({-0.1f, 0.4f, 0.25f}, 0.5f)};
    return scene;
}

/// The spheres half transparent, seen through the back of a wall by an orthographic camera.
scene::Scene veiledSpheres() {
    scene::Scene scene = scene::cornellSpheresScene();
    for (scene::Material& material : scene.materials) {
        material.alphaMode = scene::AlphaMode::Blend;
        material.baseColor.a = 0.5f;
    }
    scene.cameras = {scene::lookAt({0.4f, 0.5f, -1.5f}, {0, 0.25f, 0}, {0, 1, 0}, 0.6f)};
    scene.cameras[0].orthographic = true;
    scene.cameras[0].halfHeight = 0.3f;
    return scene;
}

/// The G-buffer does not see through mirrors.
const PathtraceSettings ownLayers{.throughMirrors = false, .throughGlass = false};

class GBufferTest : public PassTest {
  protected:
    struct Both {
        GBufferImages seen;
        PathtraceLayers traced;
    };

    /// Runs both passes in one frame.
    Both lookBothWays(Stage& stage, const CameraLaunch& launch, const PathtraceSettings& settings = ownLayers,
                      const scene::SceneFrame* moved = nullptr) {
        stage.graph.beginFrame();
        if (moved) deform(stage.graph, stage.scene, *moved);
        const Both both{gbuffer(stage.graph, stage.scene, {}, launch),
                        pathtraceLayers(stage.graph, stage.scene, settings, pathLaunch(launch))};
        stage.graph.execute(device());
        return both;
    }

    /// On CPUs the values are equal bit for bit, except for the sign of 0: the path tracer's sum over samples
    /// starts with +0. A GPU's compiler may contract the same expression differently in two shaders.
    size_t differentValues(Stage& stage, gpu::ImageHandle a, gpu::ImageHandle b) {
        const std::vector<float> x = stage.graph.downloadFloat(device(), a),
                                 y = stage.graph.downloadFloat(device(), b);
        size_t different = x.size() != y.size();
        for (size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
            const float tolerance = device().isCpu() ? 0.0f : 1e-5f * (1.0f + std::abs(x[i]));
            different += !(std::abs(x[i] - y[i]) <= tolerance);
        }
        return different;
    }

    void expectSameLayers(Stage& stage, const Both& both, const std::string& what) {
        // Rays that graze an edge may then hit another surface.
        const size_t allowed = device().isCpu() ? 0 : size_t{extent.width} * extent.height / 1000;
        for (const LayerInfo& layer : frameLayers) {
            EXPECT_EQ(static_cast<bool>(both.seen[layer]), layer.ofFirstHit) << layer.name;
            if (!layer.ofFirstHit || !layer.isMean()) continue;
            EXPECT_LE(differentValues(stage, both.seen[layer], both.traced[layer]), allowed)
                << layer.name << ", " << what;
        }
        if (!device().isCpu()) return;
        EXPECT_EQ(stage.graph.downloadUint(device(), both.seen.ids),
                  stage.graph.downloadUint(device(), both.traced.ids))
            << what;
    }

    void checkStill(const scene::Scene& scene) {
        Stage stage(device(), scene, GetParam());
        CameraLaunch launch = centredLaunch(scene, extent);
        expectSameLayers(stage, lookBothWays(stage, launch), scene.name + ", centred");
        launch.jitter = Jitter::Pixel;
        launch.firstSample = launch.stream = 3;
        launch.seed = 5;
        expectSameLayers(stage, lookBothWays(stage, launch), scene.name + ", jittered");
    }

    void checkMoving(scene::Scene scene, const std::string& path, double time) {
        scene::chooseClip(scene, "");
        Stage stage(device(), scene, GetParam());
        const scene::Camera camera = scene.cameras.at(0);
        const Sequence sequence(scene, stage.data, camera, scene::builtinCameraPath(path, scene, camera, 2.0),
                                {.framesPerSecond = 30.0, .start = time - 1.0 / 30.0});
        const Moment moment = sequence.moment(1, extent);
        CameraLaunch launch = centredLaunch(scene, extent);
        launch.camera = moment.camera;
        launch.previousCamera = moment.previousCamera.value();
        launch.hasPrevious = true;
        const Both both = lookBothWays(stage, launch, ownLayers, &moment.scene.value());
        expectSameLayers(stage, both, scene.name);
        size_t moved = 0;
        for (const vec4& motion : pixels(stage, both.seen.motion))
            moved += motion.w == 1.0f && motion.x != 0.0f;
        EXPECT_GT(moved, size_t{extent.width} * extent.height / 4) << "the test would prove little";
    }

    /// Checks every pixel that sees the floor, lit by the scene's single light.
    size_t checkFloor(Stage& stage, const scene::Scene& scene, const CameraLaunch& launch,
                      const GBufferSettings& settings) {
        const GBufferImages images = look(stage, launch, settings);
        const std::vector<vec4> light = pixels(stage, images.light);
        const std::vector<uint32_t> ids = stage.graph.downloadUint(device(), images.ids);
        const scene::PunctualLight& lamp = scene.lights.at(0);
        size_t shadowed = 0;
        double worst = 0.0;
        for (uint32_t p = 0; p < light.size(); ++p) {
            if (ids[2 * p] != 0) continue;
            const dvec3 point =
                floorPoint(launch.camera, launch.extent, p % launch.extent.width, p / launch.extent.width);
            const dvec3 d = dvec3(lamp.position) - point;
            const double d2 = glm::dot(d, d);
            const dvec3 crossing = point + d * (0.7 / d.y);
            const double inside = 0.4 - std::max(std::abs(crossing.x), std::abs(crossing.z));
            if (scene.instances.size() > 1 && std::abs(inside) < 1e-3) continue;
            const bool hidden = settings.shadows && scene.instances.size() > 1 && inside > 0.0;
            const double expected =
                hidden ? 0.0 : double{0.6f} / pi64 * double{lamp.intensity.x} * d.y / std::sqrt(d2) / d2;
            shadowed += hidden;
            const double error = std::abs(double{light[p].x} - expected);
            worst = std::max(worst, expected > 0.0 ? error / expected : error);
        }
        fmt::print("floor: {} pixels in shadow, the others off by {:.2g} at worst\n", shadowed, worst);
        EXPECT_LT(worst, 1e-4);
        return shadowed;
    }
};

TEST_P(GBufferTest, HasTheLayersOfThePathTracer) {
    checkStill(scene::cornellSpheresScene());
    checkStill(scene::heavyScene());
    checkStill(punctualSpheres());
    checkStill(veiledSpheres());
}

TEST_P(GBufferTest, HasTheLayersOfThePathTracerWhereThingsMove) {
    checkMoving(scene::cornellMovingScene(), "shake", 0.6);
    checkMoving(tubeScene(), "orbit", 0.3);
}

/// Only next-event estimation finds lamps of zero size, so with the same random numbers the path tracer's
/// single scattering is the same light.
TEST_P(GBufferTest, LightOfPunctualLampsIsThePathTracers) {
    scene::Scene scene = punctualSpheres();
    PathtraceSettings settings;
    settings.maxDepth = 1;
    settings.maxTransmissionDepth = 0;
    // From outside, and from inside the glass sphere.
    for (const bool within : {false, true}) {
        if (within) scene.cameras = {scene::lookAt({0.13f, 0.1f, 0.1f}, {0, 0.2f, 0}, {0, 1, 0}, 1.2f)};
        Stage stage(device(), scene, GetParam());
        CameraLaunch launch = centredLaunch(scene, extent);
        launch.stream = 7;
        const Both both = lookBothWays(stage, launch, settings);
        const std::vector<vec4> light = pixels(stage, both.seen.light),
                                diffuse = pixels(stage, both.traced.diffuse),
                                specular = pixels(stage, both.traced.specular);
        size_t lit = 0;
        double worst = 0.0;
        for (size_t p = 0; p < light.size(); ++p) {
            const dvec3 a = vec3(light[p]), b = dvec3(vec3(diffuse[p])) + dvec3(vec3(specular[p]));
            lit += b.x > 0.0;
            if (glm::length(b) > 0.0) worst = std::max(worst, glm::length(a - b) / glm::length(b));
            ASSERT_LE(glm::length(a - b), 1e-5 * glm::length(b) + 1e-6)
                << "pixel " << p << ", within " << within;
        }
        fmt::print("{} of {} pixels lit, off by {:.2g} at worst\n", lit, light.size(), worst);
        EXPECT_GT(lit, light.size() / 10) << "the test would prove little";
    }
}

TEST_P(GBufferTest, PointLightOverAFloor) {
    scene::Scene scene = viewedFloor();
    scene.lights = {pointLight({0.3f, 1.5f, -0.2f}, 7.0f)};
    {
        Stage stage(device(), scene, GetParam());
        EXPECT_EQ(checkFloor(stage, scene, centredLaunch(scene, extent), {}), 0u);
    }
    addScreen(scene);
    Stage stage(device(), scene, GetParam());
    EXPECT_GT(checkFloor(stage, scene, centredLaunch(scene, extent), {}), 50u);
    EXPECT_EQ(checkFloor(stage, scene, centredLaunch(scene, extent), {.shadows = false}), 0u);
}

TEST_P(GBufferTest, AMirrorShowsNoLight) {
    scene::Scene scene = viewedFloor();
    scene.materials[0].metallic = 1.0f;
    scene.materials[0].roughness = 0.0f;
    scene.lights = {pointLight({0.3f, 1.5f, -0.2f}, 7.0f)};
    Stage stage(device(), scene, GetParam());
    const GBufferImages images = look(stage, centredLaunch(scene, extent));
    // Only the multiple scattering between facets in the smoothest entry of the GGX table.
    for (const vec4& light : pixels(stage, images.light)) ASSERT_LT(light.x, 1e-9f);
    for (const vec4& albedo : pixels(stage, images.albedoSpecular)) ASSERT_GT(albedo.x, 0.5f);
}

/// Next-event estimation alone has the same mean as multiple importance sampling.
TEST_P(GBufferTest, MeanLightIsThePathTracersAtDepthOne) {
    for (scene::Scene scene : {scene::cornellScene(), scene::cornellSpheresScene()}) {
        // This estimate does not include a smooth lobe's light.
        for (scene::Material& material : scene.materials)
            material.roughness = std::max(material.roughness, 0.35f);
        constexpr gpu::Extent small{24, 24};
        constexpr uint32_t frames = 256;
        Stage stage(device(), scene, GetParam());
        CameraLaunch launch = centredLaunch(scene, small), other = launch;
        other.seed = 1;
        PathtraceSettings settings;
        settings.maxDepth = 1;
        settings.maxTransmissionDepth = 0;
        constexpr size_t count = size_t{small.width} * small.height;
        std::vector<double> sum(count), squares(count), pathSum(count), pathSquares(count);
        for (uint32_t frame = 0; frame < frames; ++frame) {
            launch.stream = other.stream = frame;
            stage.graph.beginFrame();
            const GBufferImages seen = gbuffer(stage.graph, stage.scene, {}, launch);
            const PathtraceLayers traced =
                pathtraceLayers(stage.graph, stage.scene, settings, pathLaunch(other));
            stage.graph.execute(device());
            const std::vector<vec4> light = pixels(stage, seen.light),
                                    diffuse = pixels(stage, traced.diffuse),
                                    specular = pixels(stage, traced.specular);
            for (size_t p = 0; p < count; ++p) {
                const double a = double{light[p].x}, b = double{diffuse[p].x} + double{specular[p].x};
                sum[p] += a;
                squares[p] += a * a;
                pathSum[p] += b;
                pathSquares[p] += b * b;
            }
        }
        size_t judged = 0, far = 0;
        double total = 0.0, pathTotal = 0.0, variance = 0.0;
        for (size_t p = 0; p < count; ++p) {
            const double v =
                (squares[p] - sum[p] * sum[p] / frames) + (pathSquares[p] - pathSum[p] * pathSum[p] / frames);
            total += sum[p];
            pathTotal += pathSum[p];
            variance += v;
            if (v <= 1e-12) continue;
            ++judged;
            far += std::abs(sum[p] - pathSum[p]) > 3.0 * std::sqrt(v);
        }
        const double z = (total - pathTotal) / std::sqrt(variance);
        fmt::print("{}: mean {:.6f}, the path tracer's {:.6f}, z {:.2f}; |z| > 3 at {} of {} pixels\n",
                   scene.name, total / (count * frames), pathTotal / (count * frames), z, far, judged);
        EXPECT_GT(judged, count / 2);
        EXPECT_LE(far, judged / 50);
        EXPECT_LT(std::abs(z), 4.0);
    }
}

/// Under a sky of radiance 1, a floor shows its albedo, in each pixel and frame.
TEST_P(GBufferTest, LightOfAFloorUnderAWhiteSky) {
    scene::Scene scene = viewedFloor();
    scene.environment = {16, 8, std::vector<vec3>(128, vec3(1.0f))};
    Stage stage(device(), scene, GetParam());
    const CameraLaunch launch = centredLaunch(scene, extent);
    for (const vec4& light : pixels(stage, look(stage, launch).light)) ASSERT_NEAR(light.x, 0.6f, 1e-5f);
}

/// The same if all of its light comes from an eighth of the horizon, which is sampled by texel.
TEST_P(GBufferTest, MeanLightOfAFloorUnderAnUnevenSky) {
    scene::Scene scene = viewedFloor();
    scene.environment = {16, 8, {}};
    for (int i = 0; i < 128; ++i) scene.environment.radiance.emplace_back(i % 16 / 2 == 3 ? 8.0f : 0.0f);
    Stage stage(device(), scene, GetParam());
    CameraLaunch launch = centredLaunch(scene, extent);
    constexpr uint32_t frames = 32;
    double sum = 0.0, squares = 0.0;
    for (launch.stream = 0; launch.stream < frames; ++launch.stream) {
        for (const vec4& light : pixels(stage, look(stage, launch).light)) {
            sum += double{light.x};
            squares += double{light.x} * double{light.x};
        }
    }
    constexpr double count = double{frames} * extent.width * extent.height;
    const double mean = sum / count, sigma = std::sqrt((squares / count - mean * mean) / count);
    fmt::print("uneven sky: mean {:.5f}, exactly 0.6; sigma {:.5f}\n", mean, sigma);
    EXPECT_LT(sigma, 0.003);
    EXPECT_LT(std::abs(mean - 0.6), 4.0 * sigma);
}

/// The base's normals lean towards the camera, so most of what the coat mirrors is below the base's horizon.
TEST_P(GBufferTest, MeanLightOfACoatOverABaseWithOtherNormals) {
    scene::Scene scene = viewedFloor();
    scene.environment = {16, 8, std::vector<vec3>(128, vec3(1.0f))};
    scene::Mesh& mesh = scene.meshes.at(0);
    mesh.normals.assign(4, vec3(0, 1, 0));
    mesh.tangents.assign(4, vec4(1, 0, 0, 1));
    mesh.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    scene.textures.push_back({"normals", 1, 1, {128, 17, 191, 255}, false, {}});
    scene::Material& material = scene.materials.at(0);
    material.baseColor = vec4(vec3(0.0f), 1.0f);
    material.normalTexture.texture = 0;
    material.clearcoat = 1.0f;
    material.clearcoatRoughness = 0.6f;
    Stage stage(device(), scene, GetParam());
    CameraLaunch launch = centredLaunch(scene, extent);
    constexpr uint32_t frames = 16;
    double sum = 0.0, squares = 0.0, albedo = 0.0;
    for (launch.stream = 0; launch.stream < frames; ++launch.stream) {
        const GBufferImages images = look(stage, launch);
        for (const vec4& light : pixels(stage, images.light)) {
            sum += double{light.x};
            squares += double{light.x} * double{light.x};
        }
        for (const vec4& share : pixels(stage, images.albedoSpecular)) albedo += double{share.x};
    }
    constexpr double count = double{frames} * extent.width * extent.height;
    const double mean = sum / count, sigma = std::sqrt((squares / count - mean * mean) / count);
    const double expected = albedo / count;
    fmt::print("coat: mean {:.5f}, its albedo {:.5f}; sigma {:.5f}\n", mean, expected, sigma);
    EXPECT_GT(expected, 0.02);
    EXPECT_LT(sigma, 0.02 * expected);
    EXPECT_NEAR(mean, expected, 4.0 * sigma + 0.03 * expected);
}

/// Positions lie on the primary ray through the point given by the random numbers, and normals are those of
/// the triangles.
TEST_P(GBufferTest, PositionsAreWhereTheRaysMeetTheFloor) {
    const scene::Scene scene = viewedFloor();
    Stage stage(device(), scene, GetParam());
    CameraLaunch launch = centredLaunch(scene, extent);
    launch.jitter = Jitter::Pixel;
    launch.firstSample = launch.stream = 2;
    launch.seed = 9;
    const GBufferImages images = look(stage, launch);
    const std::vector<vec4> position = pixels(stage, images.position), depth = pixels(stage, images.depth),
                            normal = pixels(stage, images.geometricNormal);
    for (uint32_t p = 0; p < position.size(); ++p) {
        uint32_t rng = startStream(p, launch.stream, launch.seed);
        const double x = p % extent.width + double{pcg(rng)}, y = p / extent.width + double{pcg(rng)};
        const CameraParams& c = launch.camera;
        const dvec3 direction =
            glm::normalize(dvec3(c.forward) + (2.0 * x / extent.width - 1.0) * dvec3(c.right) +
                           (1.0 - 2.0 * y / extent.height) * dvec3(c.up));
        const dvec3 expected = dvec3(c.origin) + double{depth[p].x} * direction;
        ASSERT_EQ(depth[p].y, 1.0f);
        ASSERT_LT(glm::length(dvec3(vec3(position[p])) - expected), 2e-5) << "pixel " << p;
        ASSERT_EQ(position[p].w, 10.0f) << "the largest coordinate of the floor";
        ASSERT_EQ(normal[p], vec4(0, 1, 0, 0));
    }
}

TEST_P(GBufferTest, WhereNothingIsHitAllIsEmpty) {
    scene::Scene scene = floorScene(vec3(0.6f));
    scene.cameras = {scene::lookAt({0, 4, 4}, {0, 10, 0}, {0, 1, 0}, 0.6f)};
    scene.lights = {pointLight({0.3f, 1.5f, -0.2f}, 7.0f)};
    Stage stage(device(), scene, GetParam());
    const GBufferImages images = look(stage, centredLaunch(scene, extent));
    for (const gpu::ImageHandle image :
         {images.light, images.position, images.geometricNormal, images.depth}) {
        for (const vec4& pixel : pixels(stage, image)) ASSERT_EQ(pixel, vec4(0.0f));
    }
    for (const uint32_t id : stage.graph.downloadUint(device(), images.ids)) ASSERT_EQ(id, layout::NONE);
}

TEST_P(GBufferTest, CountsItsRays) {
    scene::Scene scene = viewedFloor();
    scene.lights = {pointLight({0.3f, 1.5f, -0.2f}, 7.0f)};
    Stage stage(device(), scene, GetParam());
    const CameraLaunch launch = centredLaunch(scene, extent);
    constexpr uint64_t count = uint64_t{extent.width} * extent.height;
    const auto rays = [&](const GBufferSettings& settings) {
        return sumCounters(stage.graph.downloadUint(device(), look(stage, launch, settings).counters)).rays;
    };
    EXPECT_EQ(rays({}), 2 * count);
    EXPECT_EQ(rays({}), 4 * count);
    EXPECT_EQ(rays({.shadows = false}), 5 * count);
    EXPECT_EQ(rays({.light = false}), 6 * count);
}

TEST_P(GBufferTest, PassesTheBacksOfSingleSidedWalls) {
    const scene::Scene scene = veiledSpheres();
    Stage stage(device(), scene, GetParam());
    const CameraLaunch launch = centredLaunch(scene, extent);
    const GBufferImages images = look(stage, launch, {.light = false});
    constexpr uint64_t count = uint64_t{extent.width} * extent.height;
    EXPECT_GT(sumCounters(stage.graph.downloadUint(device(), images.counters)).rays, count + count / 8);
    uint64_t hits = 0;
    for (const vec4& depth : pixels(stage, images.depth)) hits += depth.y == 1.0f;
    EXPECT_GT(hits, count / 8);
}

TEST_P(GBufferTest, EveryParameterChangesTheLight) {
    const scene::Scene scene = scene::cornellScene();
    Stage stage(device(), scene, GetParam());
    const CameraLaunch launch = centredLaunch(scene, extent);
    const std::vector<vec4> before = pixels(stage, look(stage, launch).light);
    for (const ParamInfo& info : gbufferParams().infos()) {
        GBufferSettings changed;
        ASSERT_TRUE(gbufferParams().set(changed, info.name, "off"));
        ASSERT_NE(changed, GBufferSettings{}) << info.name;
        EXPECT_NE(pixels(stage, look(stage, launch, changed).light), before) << info.name;
    }
    CameraLaunch other = launch;
    other.stream = 1;
    EXPECT_NE(pixels(stage, look(stage, other).light), before);
    other = launch;
    other.seed = 1;
    EXPECT_NE(pixels(stage, look(stage, other).light), before);
}

INSTANTIATE_TEST_SUITE_P(Tracers, GBufferTest, testing::ValuesIn(ownTracers), nameOfTracer);

}  // namespace
}  // namespace limpid::test
