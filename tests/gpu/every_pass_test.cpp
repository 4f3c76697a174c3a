// Runs every integrator with every denoiser, tracer and backing, in pictures of a few pixels. It does not
// check the pictures (other tests do), but that every pass runs under the sanitizers and the validation
// layer.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "denoise/kpcn/kpcn_weights.h"
#include "passes/tonemap/tonemap.h"
#include "renderer/frame/frame_renderer.h"
#include "renderer/sequence/sequence.h"
#include "scene/motion/movement.h"
#include "tests/gpu/render_fixture.h"
#include "tests/reference/moving_scenes.h"

namespace limpid::test {
namespace {

struct Way {
    scene::Tracer tracer;
    gpu::Backing filters;
};

std::string nameOf(const testing::TestParamInfo<Way>& info) {
    return std::string(scene::toString(info.param.tracer)) +
           (info.param.filters == gpu::Backing::Buffer ? "_buffers" : "_images");
}

/// A tube with skin and morph targets, lit by the sky and a lamp that a node moves.
scene::Scene movingScene() {
    scene::Scene scene = tubeScene();
    scene::chooseClip(scene, "");
    return scene;
}

class EveryPassTest : public GpuTest, public testing::WithParamInterface<Way> {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped()) return;
        if (GetParam().tracer == scene::Tracer::Hardware && !device().info().rayTracing) {
            GTEST_SKIP() << "NOT TESTED: " << device().info().name
                         << " has no ray-tracing pipelines; scripts/lavapipe25.sh fetches a driver that has.";
        }
        scene_ = movingScene();
        const scene::SceneData data = scene::buildSceneData(scene_);
        gpuScene_.emplace(device(), data, scene::TraceOptions{GetParam().tracer, {}});
        sequence_.emplace(scene_, data, scene_.cameras.at(0), std::nullopt,
                          SequenceTiming{.framesPerSecond = 8.0});
    }

    std::shared_ptr<denoise::KpcnNetwork> network(denoise::KpcnPrecision precision) {
        const std::string file = std::string(LIMPID_SOURCE_DIR) + "/tests/data/kpcn_small.safetensors";
        return std::make_shared<denoise::KpcnNetwork>(device(), denoise::readKpcnWeights(file), precision);
    }

    /// Renders frames; downloads and dumps everything of the last one.
    void renderFrames(const RenderSettings& settings, uint32_t samples) {
        FrameRenderer renderer(device(), *gpuScene_, settings, samples);
        renderer.setFilterBacking(GetParam().filters);
        renderer.setDisplay([](gpu::FrameGraph& graph, const FrameImages& images) {
            if (images.beauty) return tonemap(graph, images.beauty, 0.0f);
            return tonemap(graph, images.diffuse, 0.0f, images.emission);
        });
        for (uint64_t frame = 0; frame < 3; ++frame)
            renderer.render(sequence_->moment(frame, settings.extent));
        const RenderedLayers layers = renderer.download();
        const std::vector<float> beauty = beautyOf(layers).pixels;
        ASSERT_EQ(beauty.size(), size_t{3} * settings.extent.width * settings.extent.height);
        EXPECT_TRUE(std::ranges::all_of(beauty, [](float v) { return std::isfinite(v); }));
        EXPECT_TRUE(std::ranges::any_of(beauty, [](float v) { return v > 0.0f; }));
        renderer.counters();
        renderer.disocclusionCounts();
        renderer.motion();
        renderer.denoisingBytes();
        std::set<std::string> passes;
        for (const gpu::PassTime& pass : renderer.passTimes()) passes.insert(pass.name);
        EXPECT_FALSE(passes.empty());
        for (const std::string& pass : passes) {
            run_.insert(pass);
            if (pass.starts_with("deform/")) continue;  // writes the scene's buffers, but no image
            for (const auto& [name, picture] : renderer.dump(pass))
                EXPECT_FALSE(picture.pixels.empty()) << name;
        }
    }

    scene::Scene scene_;
    std::optional<scene::GpuScene> gpuScene_;
    std::optional<Sequence> sequence_;
    std::set<std::string> run_;  ///< the passes that ran
};

TEST_P(EveryPassTest, Runs) {
    for (const Pipeline& pipeline : pipelines()) {
        if (pipeline.integrator == Integrator::Direct) continue;  // uses the same passes as the path tracer
        SCOPED_TRACE(pipeline.title());
        RenderSettings settings;
        settings.pipeline = pipeline;
        settings.layers = true;
        settings.pathtrace.maxDepth = 3;
        std::vector<denoise::KpcnPrecision> precisions{denoise::KpcnPrecision::Float};
        const bool network = pipeline.usesNetwork();
        const denoise::KpcnPrecision fastest = denoise::kpcnPrecision(device().info(), true);
        if (network && fastest != precisions.front()) precisions.push_back(fastest);
        for (const denoise::KpcnPrecision precision : precisions) {
            if (network) settings.networks.kpcn = this->network(precision);
            for (const gpu::Extent extent : {gpu::Extent{17, 9}, {5, 12}}) {
                settings.extent = extent;
                settings.jitter = extent.width == 17 ? Jitter::Pixel : Jitter::Frame;
                settings.denoisers.taa.frames = extent.width == 17 ? 1.0f : 4.0f;
                renderFrames(settings, network ? 4 : 2);
            }
        }
    }
    for (const char* part :
         {"gbuffer", "ambient_occlusion", "accumulate/", "pathtrace", "deform", "tonemap", "temporal",
          "atrous", "svgf", "nano", "film", "kpcn", "edges", "taa", "compose"}) {
        EXPECT_TRUE(std::ranges::any_of(
            run_, [&](const std::string& pass) { return pass.find(part) != std::string::npos; }))
            << part << " did not run";
    }
}

INSTANTIATE_TEST_SUITE_P(Ways, EveryPassTest,
                         testing::Values(Way{scene::Tracer::Compute, gpu::Backing::Image},
                                         Way{scene::Tracer::Compute, gpu::Backing::Buffer},
                                         Way{scene::Tracer::Hardware, gpu::Backing::Image}),
                         nameOf);

}  // namespace
}  // namespace limpid::test
