// Tests that both tracers give the same picture: path by path with the same seed, and in the mean with
// different ones.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/sequence/sequence.h"
#include "scene/builtin/builtin.h"
#include "scene/load/load.h"
#include "scene/motion/movement.h"
#include "tests/gpu/render_fixture.h"
#include "tests/reference/moving_scenes.h"
#include "tests/reference/statistics.h"

namespace limpid::test {
namespace {

class TracersTest : public RenderTest {
  protected:
    void SetUp() override {
        RenderTest::SetUp();
        if (IsSkipped() || device().info().rayTracing) return;
        GTEST_SKIP() << "NOT TESTED: " << device().info().name
                     << " has no ray-tracing pipelines; scripts/lavapipe25.sh fetches a driver that has.";
    }

    static RenderSettings settingsOf(uint32_t width, uint32_t height) {
        RenderSettings settings;
        settings.extent = {width, height};
        return settings;
    }

    /// Renders frame `frame` of a moving scene, or frame 0 of a static one.
    RenderedLayers picture(const scene::Scene& scene, scene::Tracer tracer, const RenderSettings& settings,
                           uint64_t frame) {
        const scene::SceneData data = scene::buildSceneData(scene);
        scene::GpuScene gpuScene(device(), data, {tracer, {}});
        const Sequence sequence(scene, data, scene.cameras.at(0), {}, {.framesPerSecond = 10.0});
        FrameRenderer still(device(), gpuScene, settings, 1);
        // The previous frame is rendered too, since the next one continues its movement.
        for (uint64_t i = frame > 0 ? frame - 1 : 0; i <= frame; ++i) {
            still.begin(sequence.moment(i, settings.extent));
            still.launch();
        }
        return still.download();
    }

    void expectSamePaths(scene::Scene scene, uint64_t frame = 0) {
        if (frame > 0) scene::chooseClip(scene, "");
        const RenderSettings settings = settingsOf(160, 90);
        const RenderedLayers a = picture(scene, scene::Tracer::Compute, settings, frame);
        const RenderedLayers b = picture(scene, scene::Tracer::Hardware, settings, frame);
        size_t same = 0, bright = 0;
        const size_t pixels = a.beauty.size() / 4;
        for (size_t p = 0; p < pixels; ++p) {
            bool equal = true;
            for (size_t c = 0; c < 3; ++c) {
                const float x = a.beauty[4 * p + c], y = b.beauty[4 * p + c];
                equal = equal && std::abs(x - y) <= 1e-4f * std::max(1.0f, std::max(x, y));
                bright += x > 0.01f;
            }
            same += equal;
        }
        const double share = static_cast<double>(same) / static_cast<double>(pixels);
        fmt::print("{} frame {}: {:.3f} % of pixels equal\n", scene.name, frame, 100.0 * share);
        EXPECT_GE(share, 0.99) << scene.name;
        EXPECT_GT(bright, pixels / 4) << "the test would prove little";
    }

    struct Moments {
        std::vector<double> sum, sumOfSquares;
    };

    /// Returns the moments of red over `batches` pictures of 4 samples with different seeds.
    Moments moments(const scene::Scene& scene, scene::Tracer tracer, RenderSettings settings,
                    uint32_t firstSeed, uint32_t batches) {
        Renderer render(device(), scene, tracer);
        const size_t pixels = size_t{settings.extent.width} * settings.extent.height;
        Moments result{std::vector<double>(pixels), std::vector<double>(pixels)};
        settings.samplesPerLaunch = 4;
        for (uint32_t i = 0; i < batches; ++i) {
            settings.seed = firstSeed + i;
            const Rendered picture = render(settings, 4);
            for (size_t p = 0; p < pixels; ++p) {
                const double value = double{picture.beauty(p).r};
                result.sum[p] += value;
                result.sumOfSquares[p] += value * value;
            }
        }
        return result;
    }

    void expectSameMean(const scene::Scene& scene, uint32_t width, uint32_t height) {
        constexpr uint32_t batches = 64;
        const RenderSettings settings = settingsOf(width, height);
        const Moments a = moments(scene, scene::Tracer::Compute, settings, 1, batches);
        const Moments b = moments(scene, scene::Tracer::Hardware, settings, 10001, batches);
        constexpr double n = batches;
        size_t far = 0, judged = 0;
        double sumOfZ = 0.0;
        for (size_t p = 0; p < a.sum.size(); ++p) {
            const auto varianceOfMean = [&](const Moments& m) {
                return std::max(0.0, m.sumOfSquares[p] / n - m.sum[p] * m.sum[p] / (n * n)) / (n - 1.0);
            };
            const double deviation = std::sqrt(varianceOfMean(a) + varianceOfMean(b));
            if (deviation < 1e-9) {
                EXPECT_NEAR(a.sum[p], b.sum[p], 1e-4 * n * std::max(1.0, a.sum[p] / n));
                continue;
            }
            const double z = (a.sum[p] - b.sum[p]) / (n * deviation);
            ++judged;
            sumOfZ += z;
            far += std::abs(z) > 3.0;
        }
        const auto count = static_cast<double>(judged);
        const double share = static_cast<double>(far) / count;
        fmt::print("{}: |z| > 3 at {:.3f} % of {} pixels, sum of z / sqrt(n) {:.2f}\n", scene.name,
                   100.0 * share, judged, sumOfZ / std::sqrt(count));
        EXPECT_GT(judged, a.sum.size() / 2) << "the test would prove little";
        EXPECT_LT(share, 0.005) << scene.name;
        EXPECT_LT(std::abs(sumOfZ) / std::sqrt(count), 4.5) << scene.name;  // of the whole picture
    }

    static scene::Scene sharedScene(const char* folder, const char* file) {
        const auto name = std::filesystem::path(LIMPID_SOURCE_DIR) / "../shared/scenes" / folder / file;
        if (!std::filesystem::exists(name)) return {};
        scene::Scene scene = scene::loadScene(name);
        scene::prepare(scene);
        return scene;
    }
};

/// The Cornell box with a veil (BLEND) and a sheet with holes (MASK) hanging in it.
scene::Scene veiledBox() {
    scene::Scene scene = scene::cornellScene();
    scene.name = "veiled box";
    const vec3 centre = 0.5f * (vec3(0.0f) + vec3(0.5488f));
    for (const bool blend : {true, false}) {
        scene::Material material = lambertian({0.7f, 0.7f, 0.2f});
        material.doubleSided = true;
        material.alphaMode = blend ? scene::AlphaMode::Blend : scene::AlphaMode::Mask;
        material.baseColor.a = blend ? 0.4f : 1.0f;
        scene::MeshBuilder builder(blend ? "veil" : "sheet");
        const float z = blend ? 0.15f : 0.05f;
        for (int i = 0; i < 4; ++i) {
            const float x = centre.x - 0.25f + 0.12f * static_cast<float>(i);
            builder.quad({x, 0.1f, z}, {x + 0.11f, 0.1f, z}, {x + 0.11f, 0.5f, z}, {x, 0.5f, z});
        }
        addMesh(scene, builder.take(), material);
        if (!blend) {
            // Every other square is cut out.
            scene::Mesh& mesh = scene.meshes.back();
            for (size_t v = 0; v < mesh.positions.size(); ++v)
                mesh.colors.emplace_back(1.0f, 1.0f, 1.0f, (v / 4) % 2 == 0 ? 1.0f : 0.0f);
        }
    }
    return scene;
}

/// One large mesh in several places, one of them mirrored, above a separate floor.
scene::Scene crowdScene() {
    scene::Scene scene = plainScene();
    scene.name = "crowd";
    scene.meshes.push_back(triangleSoup(3000, 1.0f, 7));
    for (int i = 0; i < 5; ++i) {
        mat4 m = glm::translate(
            mat4(1.0f), vec3(1.5f * static_cast<float>(i) - 3.0f, 0.3f * static_cast<float>(i), 0.0f));
        m = glm::rotate(m, 0.7f * static_cast<float>(i), vec3(0.3f, 1.0f, 0.2f));
        addInstance(scene, 0, glm::scale(m, vec3(i == 2 ? -0.8f : 0.8f, 0.6f, 1.0f)));
    }
    scene::MeshBuilder builder("floor");
    builder.quad({-5, -2, 5}, {5, -2, 5}, {5, -2, -5}, {-5, -2, -5});
    scene.meshes.push_back(builder.take());
    addInstance(scene, 1);
    scene::prepare(scene);
    return scene;
}

TEST_F(TracersTest, SameSeedBuiltInScenes) {
    expectSamePaths(scene::cornellScene());
    expectSamePaths(scene::cornellSpheresScene());
    expectSamePaths(scene::heavyScene());
}

/// The spheres below clear coats, with absorbing glass.
TEST_F(TracersTest, SameSeedCoatsAndAbsorption) {
    scene::Scene scene = scene::cornellSpheresScene();
    scene.name = "coated spheres";
    for (scene::Material& material : scene.materials) {
        material.clearcoat = 0.8f;
        material.clearcoatRoughness = 0.2f;
        if (!material.thin) material.absorption = vec3(2.0f, 8.0f, 20.0f);
    }
    const scene::SceneFeatures features = scene::buildSceneData(scene).features;
    ASSERT_TRUE(features.clearcoat && features.volume);
    expectSamePaths(scene);
}

TEST_F(TracersTest, SameSeedWithAlpha) {
    expectSamePaths(veiledBox());
}

TEST_F(TracersTest, SameSeedInstances) {
    expectSamePaths(crowdScene());
}

TEST_F(TracersTest, SameSeedMoving) {
    expectSamePaths(scene::cornellMovingScene(), 7);
    expectSamePaths(tubeScene(), 6);
}

TEST_F(TracersTest, SameSeedSceneFromAFile) {
    const scene::Scene scene = sharedScene("cesium_man", "CesiumMan.gltf");
    if (scene.instances.empty()) GTEST_SKIP() << "NOT TESTED: there is no ../shared/scenes/cesium_man";
    expectSamePaths(scene, 9);
}

TEST_F(TracersTest, OtherSeedsSameMean) {
    expectSameMean(scene::cornellScene(), 96, 54);
    expectSameMean(veiledBox(), 96, 54);
}

TEST_F(TracersTest, OtherSeedsSameMeanHeavy) {
    expectSameMean(scene::heavyScene(), 96, 54);
}

}  // namespace
}  // namespace limpid::test
