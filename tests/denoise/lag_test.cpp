// Tests how quickly a denoised picture follows a light: lab-light's slides along the ceiling for a second,
// then stops.
#include <fmt/format.h>

#include <cmath>

#include "image/metrics/metrics.h"
#include "image/tonemap.h"
#include "scene/builtin/builtin_lab.h"
#include "tests/denoise/sequence_fixture.h"

namespace limpid::test {
namespace {

constexpr gpu::Extent extent{112, 63};
constexpr double framesPerSecond = 30.0;
constexpr auto stop = static_cast<uint64_t>(framesPerSecond * double{scene::labChangeTime});
constexpr uint64_t allowed = 8, steadyFrom = stop + 40, end = stop + 56;  // frames
constexpr uint32_t seeds = 2;

class LagTest : public SequenceTest {
  protected:
    void SetUp() override {
        RenderTest::SetUp();
        if (IsSkipped()) return;
        load(scene::labLightScene(), {.framesPerSecond = framesPerSecond});
    }

    static RenderSettings settings(uint32_t seed) {
        RenderSettings result = centred(extent.width, extent.height, 8);
        result.seed = seed;
        return result;
    }

    /// Returns the mean squared error of the displayed picture, from the frame in which the light has
    /// stopped.
    std::vector<double> errors(const RenderSettings& chosen, const image::Image& truth) {
        const float stops = *image::measuredExposure(truth);
        const image::Image shown = image::displayEncode(truth, stops);
        FrameRenderer renderer(device(), *gpuScene_, chosen, 1);
        std::vector<double> result;
        for (uint64_t frame = 0; frame < end; ++frame) {
            renderer.render(sequence_->moment(frame, extent));
            if (frame < stop) continue;
            const image::Image picture = image::displayEncode(beautyOf(renderer.download()), stops);
            result.push_back(std::pow(10.0, -0.1 * image::psnr(picture, shown)));
        }
        return result;
    }
};

TEST_F(LagTest, SvgfHasFollowedALightWithinEightFrames) {
    // The camera stands still, so this is the reference for every frame after the light has stopped.
    const image::Image truth = reference(end, settings(0), 1024);
    std::vector<double> mean(end - stop);
    for (uint32_t seed = 1; seed <= seeds; ++seed) {
        RenderSettings chosen = settings(seed);
        chosen.pipeline = parsePipeline("path", "svgf");
        const std::vector<double> one = errors(chosen, truth);
        for (size_t i = 0; i < mean.size(); ++i) mean[i] += one[i] / seeds;
    }
    double steady = 0.0;
    for (uint64_t i = steadyFrom - stop; i < mean.size(); ++i)
        steady += mean[i] / static_cast<double>(end - steadyFrom);
    std::string text;
    for (const double error : mean) text += fmt::format(" {:.2f}", std::sqrt(error / steady));
    fmt::print("error after the light's stop, of its steady {:.4f}:{}\n", std::sqrt(steady), text);
    EXPECT_LT(std::sqrt(steady), 0.05) << "a picture that never changes follows nothing";
    for (uint64_t i = allowed; i < mean.size(); ++i)
        EXPECT_LE(std::sqrt(mean[i] / steady), 1.2) << i << " frames after";
}

}  // namespace
}  // namespace limpid::test
