// Compares pictures whose lights are chosen by the tree with pictures whose lights are chosen by power, and
// samplers with each other: their means over many samples must agree. Slow.
#include "scene/builtin/builtin_parts.h"
#include "scene/builtin/procedural_textures.h"
#include "scene/motion/movement.h"
#include "scene/motion/scene_animator.h"
#include "scene/prepare/prepare.h"
#include "tests/gpu/render_fixture.h"

namespace limpid::test {
namespace {

using scene::MeshBuilder;
using scene::Scene;

constexpr gpu::Extent size{32, 24};
constexpr uint32_t batches = 24, samplesPerBatch = 128;

/// A floor, a wall and blocks: matt, glossy, coated, and a pane of glass.
Scene room() {
    Scene scene;
    scene.name = "room";
    scene::Material coated = scene::lambertian("coated", {0.5f, 0.2f, 0.1f});
    coated.clearcoat = 1.0f;
    scene::Material glass = scene::glossy("glass", vec3(1.0f), 0.0f, 0.0f);
    glass.transmission = 1.0f;
    scene.materials = {scene::lambertian("wall", vec3(0.7f)), scene::glossy("steel", vec3(0.8f), 1.0f, 0.3f),
                       coated, glass};
    MeshBuilder builder("room");
    builder.quad({-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}, 0);
    builder.quad({-4, 0, -4}, {4, 0, -4}, {4, 4, -4}, {-4, 4, -4}, 0);
    scene::addBlock(builder, {-1.5f, -1.0f}, {0.5f, 0.5f}, 1.4f, 0.3f, 0);
    scene::addBlock(builder, {0.3f, -0.4f}, {0.4f, 0.4f}, 0.8f, 0.7f, 1);
    scene::addBlock(builder, {1.8f, -1.2f}, {0.5f, 0.4f}, 1.1f, -0.4f, 2);
    scene::addBlock(builder, {-0.6f, 1.2f}, {0.5f, 0.1f}, 1.0f, 0.2f, 3);
    scene::addMesh(scene, builder.take(), 0);
    scene::addCamera(scene, {0.0f, 2.0f, 6.5f}, {0.0f, 1.0f, -0.5f}, 0.75f);
    return scene;
}

/// Adds emissive quads of random direction, with coordinates for a texture.
size_t addQuads(Scene& scene, uint32_t count, int material, uint32_t seed) {
    scene::Sequence random(seed);
    MeshBuilder builder("lamps");
    for (uint32_t i = 0; i < count; ++i) {
        const vec3 at(random.next(-3.5f, 3.5f), random.next(0.3f, 3.0f), random.next(-3.5f, 2.0f));
        const vec3 x(random.next(-0.2f, 0.2f), random.next(-0.2f, 0.2f), random.next(-0.2f, 0.2f));
        const vec3 y(random.next(-0.2f, 0.2f), random.next(-0.2f, 0.2f), random.next(-0.2f, 0.2f));
        builder.quad(at, at + x, at + x + y, at + y);
    }
    scene::Mesh mesh = builder.take();
    const vec2 corners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (size_t i = 0; i < mesh.positions.size(); ++i) mesh.uv0.push_back(corners[i % 4]);
    return scene::addMesh(scene, std::move(mesh), material);
}

Scene texturedLamps() {
    Scene scene = room();
    scene::Material sign = scene::emitter("sign", vec3(0.2f), {9.0f, 6.0f, 3.0f});
    sign.emissionTexture =
        scene::addTexture(scene, scene::checkerTexture(4, vec3(1.0f), {0.0f, 0.05f, 0.3f}));
    sign.doubleSided = true;
    scene.materials.push_back(sign);
    addQuads(scene, 24, static_cast<int>(scene.materials.size() - 1), 1);
    return scene;
}

Scene spots() {
    Scene scene = room();
    scene::Sequence random(2);
    for (int i = 0; i < 30; ++i) {
        scene::PunctualLight lamp;
        lamp.kind = i % 5 == 0 ? scene::PunctualLight::Kind::Point : scene::PunctualLight::Kind::Spot;
        lamp.position = {random.next(-3.5f, 3.5f), random.next(1.5f, 4.0f), random.next(-3.5f, 4.0f)};
        const vec3 target(random.next(-3.0f, 3.0f), 0.0f, random.next(-3.0f, 2.0f));
        lamp.direction = glm::normalize(target - lamp.position);
        lamp.outerCone = random.next(0.1f, 0.7f);
        lamp.innerCone = 0.5f * lamp.outerCone;
        lamp.intensity = vec3(random.next(1.0f, 10.0f), random.next(1.0f, 10.0f), random.next(1.0f, 10.0f));
        if (i % 3 == 0) lamp.range = 5.0f;
        scene.lights.push_back(lamp);
    }
    return scene;
}

/// A sky, two suns, lamps and emissive quads.
Scene everything() {
    Scene scene = room();
    scene.materials.push_back(scene::emitter("lamp", vec3(0.2f), {4.0f, 8.0f, 12.0f}));
    addQuads(scene, 12, static_cast<int>(scene.materials.size() - 1), 3);
    scene.environment = {16, 8, {}};
    for (uint32_t i = 0; i < 128; ++i)
        scene.environment.radiance.emplace_back(0.1f + 0.02f * static_cast<float>(i % 16));
    scene::PunctualLight lamp, sun, evening;
    lamp.position = {1.0f, 2.0f, 1.0f};
    lamp.intensity = vec3(4.0f);
    sun.kind = evening.kind = scene::PunctualLight::Kind::Directional;
    sun.direction = glm::normalize(vec3(-1.0f, -2.0f, -1.0f));
    evening.direction = glm::normalize(vec3(2.0f, -0.5f, -1.0f));
    evening.intensity = {1.0f, 0.4f, 0.1f};
    scene.lights = {lamp, sun, evening};
    return scene;
}

/// Quads that turn and shrink, and a lamp that moves, at half a second.
Scene moving() {
    Scene scene = room();
    scene.materials.push_back(scene::emitter("lamp", vec3(0.2f), {12.0f, 8.0f, 4.0f}));
    const auto lampMaterial = static_cast<int>(scene.materials.size() - 1);
    addQuads(scene, 10, lampMaterial, 4);
    const int node = scene::addNode(scene, addQuads(scene, 10, lampMaterial, 5));
    scene::PunctualLight lamp;
    lamp.intensity = vec3(5.0f);
    lamp.node = node;
    scene.lights = {lamp};
    using scene::AnimatedValue, scene::Interpolation;
    scene::addClip(
        scene,
        {"turning",
         {{node, AnimatedValue::Rotation, Interpolation::Linear, 4, {0.0f, 1.0f}, {0, 0, 0, 1, 0, 1, 0, 0}},
          {node, AnimatedValue::Scale, Interpolation::Linear, 3, {0.0f, 1.0f}, {1, 1, 1, 0.5f, -1, 0.5f}},
          {node, AnimatedValue::Translation, Interpolation::Linear, 3, {0.0f, 1.0f}, {0, 0, 0, 1, 3, 1}}}});
    return scene;
}

/// Mean and variance of the mean of every pixel's luminance.
struct Estimate {
    std::vector<double> mean, variance;
};

class LightSelectionTest : public RenderTest {
  protected:
    static PathtraceSettings byTree() {
        PathtraceSettings settings;
        settings.lightTree = true;
        return settings;
    }
    static PathtraceSettings byPower(bool sobol = false) {
        PathtraceSettings settings;
        settings.lightTree = false;
        settings.samplerSobol = sobol;
        return settings;
    }

    /// Compares each of `tested` with lights chosen by power.
    void check(Scene scene, scene::Tracer tracer, const std::vector<PathtraceSettings>& tested) {
        if (tracer == scene::Tracer::Hardware && !device().info().rayTracing) return;
        scene::prepare(scene);
        const bool moves = !scene.rig.clips.empty();
        if (moves) scene::chooseClip(scene, "");
        const scene::SceneData data = scene::buildSceneData(scene, {}, true);
        scene::GpuScene onDevice(device(), data, {tracer, {}});
        Moment moment;
        moment.camera = scene::cameraParams(scene.cameras.at(0), size.width, size.height);
        if (moves) moment.scene = scene::SceneAnimator(scene, data).frame(0.5, 0.5);
        const Estimate known = estimate(onDevice, moment, byPower(), 2);
        for (const PathtraceSettings& settings : tested) {
            SCOPED_TRACE(scene.name + (settings.lightTree ? ", by the tree" : ", by power, Sobol'"));
            expectEqual(estimate(onDevice, moment, settings, 1), known);
        }
    }

    /// One sample for each pixel, through the scene's first camera.
    std::vector<float> firstSample(const Scene& scene, const PathtraceSettings& pathtrace) {
        scene::GpuScene onDevice(device(), scene::buildSceneData(scene, {}, true));
        FrameRenderer renderer(device(), onDevice, {}, 1);
        RenderSettings settings;
        settings.extent = size;
        settings.pathtrace = pathtrace;
        renderer.setSettings(settings);
        renderer.render({.camera = scene::cameraParams(scene.cameras.at(0), size.width, size.height)});
        return renderer.download().beauty;
    }

  private:
    static void expectEqual(const Estimate& a, const Estimate& known) {
        double noise = 0.0, knownNoise = 0.0, light = 0.0, knownLight = 0.0;
        uint32_t apart = 0;
        for (size_t i = 0; i < a.mean.size(); ++i) {
            const double variance = a.variance[i] + known.variance[i];
            apart += std::abs(zOf((a.mean[i] - known.mean[i]) / std::sqrt(std::max(variance, 1e-20)))) > 3.0;
            noise += a.variance[i];
            knownNoise += known.variance[i];
            light += a.mean[i];
            knownLight += known.mean[i];
        }
        // Pixels are nearly independent, so the whole picture's mean is known much better than a pixel's.
        const double z = (light - knownLight) / std::sqrt(noise + knownNoise);
        fmt::print(
            "{} of {} pixels are more than 3 standard errors apart, the mean {:.2f}; variance {:.3f} of that "
            "by "
            "power\n",
            apart, a.mean.size(), z, noise / knownNoise);
        EXPECT_GT(light, 0.0);
        EXPECT_LT(std::abs(z), 4.0);
        EXPECT_LE(apart,
                  a.mean.size() / 96);  // 0.27 % are expected; four times as many by chance in 1 of 3,000
    }

    /// Student's t of two means of `batches` values as a normal deviate: the tails have the same probability.
    static double zOf(double t) {
        constexpr double freedom = 2.0 * (batches - 1);
        return t * (1.0 - 0.25 / freedom) / std::sqrt(1.0 + 0.5 * t * t / freedom);
    }

    /// `which`: 1 or 2; they have different seeds.
    Estimate estimate(scene::GpuScene& scene, const Moment& moment, const PathtraceSettings& pathtrace,
                      uint32_t which) {
        FrameRenderer renderer(device(), scene, {}, UINT64_MAX);
        RenderSettings settings;
        settings.extent = size;
        settings.samplesPerLaunch = 4;
        settings.pathtrace = pathtrace;
        const size_t pixels = size_t{size.width} * size.height;
        Estimate result{std::vector<double>(pixels), std::vector<double>(pixels)};
        for (uint32_t batch = 0; batch < batches; ++batch) {
            settings.seed = 2 * batch + which;
            renderer.setSettings(settings);
            renderer.begin(moment);
            while (renderer.samplesInMean() < samplesPerBatch) renderer.launch();
            const RenderedLayers layers = renderer.download();
            for (size_t i = 0; i < pixels; ++i) {
                const float* p = &layers.beauty[4 * i];
                const double value = 0.2126 * double{p[0]} + 0.7152 * double{p[1]} + 0.0722 * double{p[2]};
                result.mean[i] += value / batches;
                result.variance[i] += value * value / batches;
            }
        }
        for (size_t i = 0; i < pixels; ++i) {
            const double spread = std::max(result.variance[i] - result.mean[i] * result.mean[i], 0.0);
            result.variance[i] = spread / (batches - 1);
        }
        return result;
    }
};

constexpr scene::Tracer tracers[] = {scene::Tracer::Compute, scene::Tracer::Hardware};

TEST_F(LightSelectionTest, TexturedLamps) {
    for (const scene::Tracer tracer : tracers) check(texturedLamps(), tracer, {byTree()});
}

TEST_F(LightSelectionTest, Spots) {
    for (const scene::Tracer tracer : tracers) check(spots(), tracer, {byTree(), byPower(true)});
}

TEST_F(LightSelectionTest, SkySunsAndLamps) {
    for (const scene::Tracer tracer : tracers) check(everything(), tracer, {byTree(), byPower(true)});
}

TEST_F(LightSelectionTest, MovingLights) {
    for (const scene::Tracer tracer : tracers) check(moving(), tracer, {byTree()});
}

/// By power, every sample would evaluate all of them.
TEST_F(LightSelectionTest, MoreThan256LampsAreAlwaysChosenByTheTree) {
    Scene scene = spots();
    scene.lights.resize(256, scene.lights.front());
    for (int i = 0; i < 3; ++i) {
        scene.lights.push_back({});
        scene.lights.back().kind = scene::PunctualLight::Kind::Directional;
    }
    scene::prepare(scene);
    EXPECT_NE(firstSample(scene, byTree()), firstSample(scene, byPower(true)));
    scene.lights.push_back(scene.lights.front());
    EXPECT_EQ(firstSample(scene, byTree()), firstSample(scene, byPower(true)));
}

}  // namespace
}  // namespace limpid::test
