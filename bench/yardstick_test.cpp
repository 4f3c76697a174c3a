// Checks the yardstick: it gives the furnace's exact brightness, and the pictures and ray counts of our path
// tracer.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "embree_tracer.h"
#include "scene/builtin/builtin.h"
#include "scene/prepare/prepare.h"
#include "tests/gpu/render_fixture.h"

namespace limpid::test {
namespace {

using bench::EmbreeLaunch;
using bench::EmbreeScene;

scene::Scene prepared(scene::Scene scene) {
    scene::prepare(scene);
    return scene;
}

EmbreeLaunch launchOf(const scene::Scene& scene, const RenderSettings& settings) {
    return {.camera = scene::cameraParams(scene.cameras.at(0), settings.extent.width, settings.extent.height),
            .width = settings.extent.width,
            .height = settings.extent.height,
            .seed = settings.seed,
            .maxDepth = static_cast<uint32_t>(settings.pathtrace.maxDepth),
            .rouletteDepth = static_cast<uint32_t>(settings.pathtrace.rouletteDepth)};
}

/// Statistics of the luminance of 8x8 pixel blocks, at one sample per pixel.
class BlockMoments {
  public:
    explicit BlockMoments(gpu::Extent extent)
        : width_(extent.width),
          columns_((extent.width + 7) / 8),
          sum_(size_t{columns_} * ((extent.height + 7) / 8)),
          squares_(sum_.size()) {}

    /// `radiance`: four floats per pixel.
    void add(std::span<const float> radiance) {
        std::vector<double> blocks(sum_.size());
        for (size_t i = 0; i < radiance.size() / 4; ++i) {
            const float* p = &radiance[4 * i];
            blocks[i / width_ / 8 * columns_ + i % width_ / 8] +=
                0.2126 * double{p[0]} + 0.7152 * double{p[1]} + 0.0722 * double{p[2]};
        }
        for (size_t i = 0; i < blocks.size(); ++i) {
            sum_[i] += blocks[i];
            squares_[i] += blocks[i] * blocks[i];
        }
        ++count_;
    }

    size_t blocks() const { return sum_.size(); }
    double mean(size_t block) const { return sum_[block] / count_; }
    /// Returns the squared standard error of the mean.
    double meanVariance(size_t block) const {
        const double mean = this->mean(block);
        return std::max(0.0, squares_[block] / count_ - mean * mean) / (count_ - 1);
    }

  private:
    size_t width_, columns_;
    std::vector<double> sum_, squares_;
    double count_ = 0;
};

class YardstickTest : public RenderTest {
  protected:
    static RenderSettings settings(uint32_t width, uint32_t height, uint32_t seed) {
        RenderSettings result;
        result.extent = {width, height};
        result.seed = seed;
        result.pathtrace.maxDepth = 4;
        result.pathtrace.lightTree = false;
        result.pathtrace.samplerSobol = false;
        return result;
    }

    static std::span<const float> floatsOf(const std::vector<vec4>& pixels) {
        return {&pixels.data()->x, 4 * pixels.size()};
    }

    void comparePaths(const scene::Scene& scene) {
        const RenderSettings common = settings(160, 90, 0);
        const scene::SceneData data = scene::buildSceneData(scene);
        const EmbreeScene embree(scene, data);
        EmbreeLaunch launch = launchOf(scene, common);
        std::vector<vec4> sum(size_t{launch.width} * launch.height);
        constexpr uint32_t samples = 4;
        uint64_t rays = 0;
        for (launch.frame = 0; launch.frame < samples; ++launch.frame)
            rays += traceSample(embree, launch, sum);
        const Rendered ours = render(scene, common, samples);
        size_t different = 0;
        for (size_t i = 0; i < sum.size(); ++i) {
            const vec3 expected = vec3(sum[i]) / static_cast<float>(samples), found = ours.beauty(i);
            if (glm::length(found - expected) > 1e-3f * glm::length(expected) + 1e-6f) ++different;
        }
        const double rayRatio = static_cast<double>(ours.counters.rays) / static_cast<double>(rays);
        fmt::print("{}: {} of {} pixels differ by more than rounding; rays {} and {} ({:+.4f} %)\n",
                   scene.name, different, sum.size(), ours.counters.rays, rays, 100 * (rayRatio - 1));
        EXPECT_LE(different, sum.size() / 50);
        EXPECT_NEAR(rayRatio, 1.0, 5e-3);
    }

    /// Uses different seeds: the pictures only share their expectation.
    void compareMeans(const scene::Scene& scene) {
        const RenderSettings ourSettings = settings(160, 90, 0), theirSettings = settings(160, 90, 7);
        constexpr uint32_t samples = 64;
        const scene::SceneData data = scene::buildSceneData(scene);
        const EmbreeScene embree(scene, data);
        EmbreeLaunch launch = launchOf(scene, theirSettings);
        BlockMoments theirs(theirSettings.extent), ours(ourSettings.extent);
        scene::GpuScene gpuScene(device(), data);
        FrameRenderer still(device(), gpuScene, ourSettings, samples);
        still.begin({.camera = launch.camera});
        std::vector<float> before(size_t{launch.width} * launch.height * 4, 0.0f);
        for (launch.frame = 0; launch.frame < samples; ++launch.frame) {
            std::vector<vec4> sum(size_t{launch.width} * launch.height);
            traceSample(embree, launch, sum);
            theirs.add(floatsOf(sum));
            still.launch();
            ours.add(newestSample(still.download().beauty, before, launch.frame));
        }
        compareBlocks(scene.name, ours, theirs);
    }

    /// Returns the sample that was added to the running mean `before` of `count` samples to make `after`, and
    /// sets `before` to `after`.
    static std::vector<float> newestSample(std::vector<float> after, std::vector<float>& before,
                                           uint32_t count) {
        std::vector<float> newest(after.size());
        const auto n = static_cast<float>(count);
        for (size_t i = 0; i < after.size(); ++i) newest[i] = after[i] * (n + 1.0f) - before[i] * n;
        before = std::move(after);
        return newest;
    }

    static void compareBlocks(const std::string& name, const BlockMoments& a, const BlockMoments& b) {
        size_t beyond = 0, count = 0;
        double sum = 0.0;
        for (size_t i = 0; i < a.blocks(); ++i) {
            const double variance = a.meanVariance(i) + b.meanVariance(i);
            if (variance <= 0.0) {
                EXPECT_NEAR(a.mean(i), b.mean(i), 1e-4 * std::abs(b.mean(i))) << name << ", block " << i;
                continue;
            }
            const double z = (a.mean(i) - b.mean(i)) / std::sqrt(variance);
            ++count;
            sum += z;
            beyond += std::abs(z) > 3.0;
        }
        fmt::print("{}: {} of {} blocks beyond 3 sigma; sum of z {:+.2f} sigma\n", name, beyond, count,
                   sum / std::sqrt(static_cast<double>(count)));
        EXPECT_GT(count, a.blocks() / 2);
        // By chance 0.27 % are outside, with a standard deviation of the square root of their number.
        const double expected = 0.0027 * static_cast<double>(count);
        EXPECT_LE(static_cast<double>(beyond), expected + 4.0 * std::sqrt(expected));
        EXPECT_LT(std::abs(sum) / std::sqrt(static_cast<double>(count)), 4.0);
    }
};

TEST_F(YardstickTest, TheSamePathsAsOurs) {
    for (const char* name : {"cornell", "heavy"}) comparePaths(prepared(scene::builtinScene(name)));
}

TEST_F(YardstickTest, TheSameMeansAsOurs) {
    for (const char* name : {"cornell", "heavy"}) compareMeans(prepared(scene::builtinScene(name)));
}

/// The following test uses no Vulkan device.
TEST(EmbreeTracerTest, TheFurnaceHasItsExactBrightness) {
    constexpr double albedo = 0.5;
    const scene::Scene scene = prepared(scene::furnaceScene(static_cast<float>(albedo)));
    const EmbreeScene embree(scene, scene::buildSceneData(scene));
    for (const uint32_t depth : {0u, 1u, 4u}) {
        RenderSettings settings;
        settings.extent = {24, 24};
        settings.pathtrace.maxDepth = static_cast<int>(depth);
        EmbreeLaunch launch = launchOf(scene, settings);
        std::vector<vec4> sum(24 * 24);
        for (launch.frame = 0; launch.frame < 512; ++launch.frame) traceSample(embree, launch, sum);
        double mean = 0.0;
        for (const vec4& pixel : sum) {
            ASSERT_EQ(pixel.w, 512.0f);
            mean += double{pixel.g} / 512.0 / static_cast<double>(sum.size());
        }
        const double expected = (1.0 - std::pow(albedo, depth + 1)) / (1.0 - albedo);
        fmt::print("furnace, depth {}: {:.5f}, exactly {:.5f}\n", depth, mean, expected);
        EXPECT_NEAR(mean / expected, 1.0, 3e-3);
    }
}

TEST(EmbreeTracerTest, OtherThanDiffuseScenesAreRefused) {
    const scene::Scene scene = prepared(scene::cornellSpheresScene());
    EXPECT_THROW(EmbreeScene(scene, scene::buildSceneData(scene)), Error);
}

}  // namespace
}  // namespace limpid::test
