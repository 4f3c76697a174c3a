// Tests that SVGF leaves no weave on flat walls: a pattern of a few pixels, from pixels whose own noise is
// underestimated. It is strongest some frames after lab-switch's light has gone out.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/builtin/builtin_lab.h"
#include "tests/denoise/sequence_fixture.h"

namespace limpid::test {
namespace {

constexpr gpu::Extent extent{112, 63};
constexpr double framesPerSecond = 30.0;
constexpr auto dark = static_cast<uint64_t>(framesPerSecond * double{scene::labChangeTime});

class WeaveTest : public SequenceTest {
  protected:
    void SetUp() override {
        RenderTest::SetUp();
        if (IsSkipped()) return;
        load(scene::labSwitchScene(), {.framesPerSecond = framesPerSecond});
    }

    std::vector<image::Image> pictures(const std::vector<uint64_t>& numbers, int meanLevels) {
        RenderSettings chosen = centred(extent.width, extent.height, 8);
        chosen.pipeline = parsePipeline("path", "svgf");
        chosen.denoisers.svgf.meanLevels = meanLevels;
        FrameRenderer renderer(device(), *gpuScene_, chosen, 1);
        std::vector<image::Image> result;
        for (uint64_t frame = 0; frame <= numbers.back(); ++frame) {
            renderer.render(sequence_->moment(frame, extent));
            if (std::ranges::count(numbers, frame) > 0) result.push_back(beautyOf(renderer.download()));
        }
        return result;
    }
};

/// The deviation of the back wall's green light from its means over 3x3 pixels, relative to its mean.
double weaveOf(const image::Image& picture) {
    constexpr uint32_t left = 47, right = 67, top = 13, bottom = 32;  // nothing but the wall
    double sum = 0.0, squares = 0.0;
    for (uint32_t y = top; y < bottom; ++y) {
        for (uint32_t x = left; x < right; ++x) {
            double mean = 0.0;
            for (uint32_t i = 0; i < 9; ++i)
                mean += double{picture.at(x + i % 3 - 1, y + i / 3 - 1, 1)} / 9.0;
            sum += mean;
            squares += std::pow(double{picture.at(x, y, 1)} - mean, 2.0);
        }
    }
    const double pixels = (right - left) * (bottom - top);
    return std::sqrt(squares / pixels) / (sum / pixels);
}

TEST_F(WeaveTest, TheMeanLuminanceLeavesLessOfItAfterALightHasGoneOut) {
    const std::vector<uint64_t> numbers{dark + 3, dark + 6};
    const std::vector<image::Image> with = pictures(numbers, denoise::SvgfSettings{}.meanLevels);
    const std::vector<image::Image> without = pictures(numbers, 0);
    for (size_t i = 0; i < numbers.size(); ++i) {
        const double is = weaveOf(with[i]), was = weaveOf(without[i]);
        fmt::print("weave in frame {}: {:.2f} % with, {:.2f} % without\n", numbers[i], 100.0 * is,
                   100.0 * was);
        EXPECT_LT(is, 0.85 * was) << numbers[i];
    }
}

}  // namespace
}  // namespace limpid::test
