// Compares blocks summed on the CPU with the running mean on the device, which uses the same random numbers.
#include "renderer/long/block_renderer.h"

#include <fmt/format.h>

#include "scene/builtin/builtin.h"
#include "scene/prepare/prepare.h"
#include "tests/gpu/render_fixture.h"

namespace limpid::test {
namespace {

class BlockRendererTest : public RenderTest {
  protected:
    static scene::Scene prepared() {
        scene::Scene scene = scene::cornellScene();
        scene::prepare(scene);
        return scene;
    }
    static RenderSettings smallLayers() {
        RenderSettings settings;
        settings.extent = {33, 17};
        settings.samplesPerLaunch = 3;
        settings.layers = true;
        settings.jitter = Jitter::Pixel;
        return settings;
    }
    static bool always(uint32_t) { return true; }

    /// Compares the components of a layer, and its variance if it has one.
    static void expectNear(const LayerSums& layer, const std::vector<float>& a, const std::vector<float>& b) {
        ASSERT_EQ(a.size(), b.size()) << layer.info->name;
        for (size_t i = 0; i < a.size(); ++i) {
            if (i % 4 >= layer.info->meanComponents() && !(layer.squares && i % 4 == 3)) continue;
            ASSERT_NEAR(a[i], b[i], 1e-4f * (std::abs(b[i]) + 1e-4f)) << layer.info->name << " " << i;
        }
    }

    /// Compares the sums of blocks with the running mean over all samples of frame `number`.
    void expectTheRunningMeans(const RenderSettings& settings, uint64_t number) {
        const scene::Scene scene = prepared();
        scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
        // The blocks' launches equal those of the running mean: 48 samples are 16 launches of 3.
        const BlockPlan plan{.samples = 120, .blockSamples = 48, .launchSamples = 3};
        FrameRenderer frames(device(), gpuScene, settings, plan.samples);
        BlockRenderer renderer(frames, plan);
        Moment moment{.camera = camera(scene, settings)};
        moment.number = number;
        renderer.begin(moment);
        FrameSums sums(settings.extent, plan, layerNames());
        for (const uint32_t block : {2u, 0u, 1u}) {
            EXPECT_EQ(renderer.render(block, always), plan.samplesOf(block));
            renderer.addTo(sums);
        }
        FrameRenderer still(device(), gpuScene, settings, 120);
        still.render(moment);
        const RenderedLayers expected = still.download(), got = sums.means();
        EXPECT_EQ(got.samples, 120u);
        EXPECT_EQ(got.ids, expected.ids);
        EXPECT_EQ(sums.counts.rays, still.counters().rays);
        EXPECT_EQ(sums.counts.clamped, 0u);
        for (const LayerSums& layer : sums.layers) {
            expectNear(layer, got[*layer.info], expected[*layer.info]);
        }
    }
};

TEST_F(BlockRendererTest, SumsAreTheRunningMeansOfTheSameSamples) {
    expectTheRunningMeans(smallLayers(), 0);
}

TEST_F(BlockRendererTest, PointsGoOnFromBlockToBlockAndFromFrameToFrame) {
    RenderSettings settings = smallLayers();
    settings.pathtrace.samplerSobol = true;
    expectTheRunningMeans(settings, 0);
    expectTheRunningMeans(settings, 7);
}

TEST_F(BlockRendererTest, APartOfABlockIsItsFirstSamples) {
    const scene::Scene scene = prepared();
    const RenderSettings settings = smallLayers();
    scene::GpuScene gpuScene(device(), scene::buildSceneData(scene));
    const BlockPlan plan{.samples = 120, .blockSamples = 48, .launchSamples = 3};
    const BlockPlan nine{.samples = 9, .blockSamples = 48, .launchSamples = 3};
    FrameSums part(settings.extent, plan, {"depth"}), whole(settings.extent, nine, {"depth"});
    FrameRenderer frames(device(), gpuScene, settings, plan.samples);
    FrameRenderer otherFrames(device(), gpuScene, settings, nine.samples);
    BlockRenderer renderer(frames, plan), other(otherFrames, nine);
    renderer.begin({.camera = camera(scene, settings)});
    other.begin({.camera = camera(scene, settings)});
    EXPECT_EQ(renderer.render(0, [](uint32_t samples) { return samples < 9; }), 9u);
    EXPECT_EQ(other.render(0, always), 9u);
    renderer.addTo(part);
    other.addTo(whole);
    EXPECT_EQ(part.samples(), 9u);
    EXPECT_EQ(part.blockCount(), 0u);
    EXPECT_EQ(part.means().diffuse, whole.means().diffuse);
    EXPECT_EQ(part.means().depth, whole.means().depth);
    EXPECT_EQ(renderer.render(0, [](uint32_t) { return false; }), 0u);
    EXPECT_THROW(renderer.addTo(whole), Error) << "nothing was rendered";
}

}  // namespace
}  // namespace limpid::test
