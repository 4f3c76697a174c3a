// Tests that SVGF leaves no patterns on flat walls. A weave of a few pixels comes from pixels whose own noise
// is underestimated; it is strongest some frames after lab-switch's light has gone out. Dots are what is left
// of fireflies, as on the ceiling of cornell-spheres.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/builtin/builtin.h"
#include "scene/builtin/builtin_lab.h"
#include "tests/denoise/sequence_fixture.h"

namespace limpid::test {
namespace {

constexpr double framesPerSecond = 30.0;
constexpr auto dark = static_cast<uint64_t>(framesPerSecond * double{scene::labChangeTime});

class WeaveTest : public SequenceTest {
  protected:
    std::vector<image::Image> pictures(gpu::Extent extent, const std::vector<uint64_t>& numbers,
                                       const denoise::SvgfSettings& settings, uint32_t seed = 0) {
        RenderSettings chosen = centred(extent.width, extent.height, 8);
        chosen.pipeline = parsePipeline("path", "svgf");
        chosen.denoisers.svgf = settings;
        chosen.seed = seed;
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
    constexpr gpu::Extent extent{112, 63};
    load(scene::labSwitchScene(), {.framesPerSecond = framesPerSecond});
    const std::vector<uint64_t> numbers{dark + 3, dark + 6};
    const std::vector<image::Image> with = pictures(extent, numbers, {}),
                                    without = pictures(extent, numbers, {.meanLevels = 0});
    for (size_t i = 0; i < numbers.size(); ++i) {
        const double is = weaveOf(with[i]), was = weaveOf(without[i]);
        fmt::print("weave in frame {}: {:.2f} % with, {:.2f} % without\n", numbers[i], 100.0 * is,
                   100.0 * was);
        EXPECT_LT(is, 0.85 * was) << numbers[i];
    }
}

/// Of the ceiling's pixels, the share that is more than 5 % brighter than the median of the 5x5 pixels
/// around.
double dotsOf(const image::Image& picture) {
    constexpr uint32_t left = 78, right = 178, top = 5, bottom = 16;  // nothing but the ceiling
    uint32_t dots = 0;
    for (uint32_t y = top; y < bottom; ++y) {
        for (uint32_t x = left; x < right; ++x) {
            std::array<float, 25> around;
            for (uint32_t i = 0; i < around.size(); ++i)
                around[i] = picture.at(x + i % 5 - 2, y + i / 5 - 2, 1);
            std::ranges::nth_element(around, around.begin() + 12);
            dots += picture.at(x, y, 1) > 1.05f * around[12] ? 1 : 0;
        }
    }
    return static_cast<double>(dots) / ((right - left) * (bottom - top));
}

double meanOf(const image::Image& picture) {
    double sum = 0.0;
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) sum += double{picture.at(x, y, 1)};
    return sum / (picture.width * picture.height);
}

/// 0.56 times as many by six seeds, and 0.43 to 0.77 by one of them.
TEST_F(WeaveTest, FirefliesLeaveFewDots) {
    constexpr gpu::Extent extent{256, 144};
    load(scene::cornellSpheresScene(), {.framesPerSecond = framesPerSecond});
    double is = 0.0, was = 0.0;
    for (const uint32_t seed : {0u, 1u, 2u}) {
        const image::Image with = pictures(extent, {10}, {}, seed).front(),
                           without = pictures(extent, {10}, {.dampOutliers = false}, seed).front();
        is += dotsOf(with) / 3.0;
        was += dotsOf(without) / 3.0;
        const double light = meanOf(with) / meanOf(without);
        EXPECT_GT(light, 0.99) << "seed " << seed;
    }
    fmt::print("dots {:.1f} % with, {:.1f} % without\n", 100.0 * is, 100.0 * was);
    EXPECT_LT(is, 0.7 * was);
}

}  // namespace
}  // namespace limpid::test
