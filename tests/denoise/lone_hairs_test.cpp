// Tests that SVGF does not take bright hairs for fireflies: they are a pixel wide, and what is beside them is
// nothing, or other hairs with other normals and distances.
#include <fmt/format.h>

#include <cmath>
#include <random>

#include "tests/denoise/denoise_fixture.h"
#include "tests/oracle/double_denoise_fixture.h"

namespace limpid::test {
namespace {

constexpr uint32_t columns = 96, rows = 64;

using Random = std::mt19937;

float uniform(Random& random) {
    return static_cast<float>(random() >> 8) * 0x1p-24f;
}

/// Hairs with one pixel in each row, before nothing. As with few samples in each pixel, their normals are
/// those of random points around them, and half of the pixels are lit.
HostFrame hairs(uint32_t seed) {
    HostFrame frame = frontalPlane(columns, rows);
    std::ranges::fill(frame.normal, 0.0f);
    std::ranges::fill(frame.albedo, 0.0f);
    std::ranges::fill(frame.depth, 0.0f);
    Random random(seed);
    for (uint32_t x = 2; x + 2 < columns; x += 3) {
        const float distance = 2.0f + uniform(random);
        for (uint32_t y = 0; y < rows; ++y) {
            const size_t p = size_t{y} * columns + x - 1 + random() % 3;
            const float angle = 2.8f * (uniform(random) - 0.5f);
            const float light = random() % 2 == 0 ? 1.0f : 0.0f;
            for (size_t c = 0; c < 3; ++c) {
                frame.diffuse[4 * p + c] = light;
                frame.albedo[4 * p + c] = 0.5f;
            }
            frame.normal[4 * p] = frame.previousNormal[4 * p] = std::sin(angle);
            frame.normal[4 * p + 2] = frame.previousNormal[4 * p + 2] = std::cos(angle);
            frame.depth[4 * p] = distance + 0.02f * uniform(random);
            frame.depth[4 * p + 1] = 1.0f;
        }
    }
    return frame;
}

class LoneHairsTest : public DenoiseTest, public testing::WithParamInterface<gpu::Backing> {
  protected:
    void SetUp() override {
        DenoiseTest::SetUp();
        filters_ = GetParam();
    }

    /// The sum of all light in the first frame of a history. The filter's levels mix hairs, but keep their
    /// mean.
    double lightOfFirst(const HostFrame& frame, float fireflies) {
        DenoiserSettings settings;
        settings.svgf.fireflies = fireflies;
        graph_.beginFrame();
        graph_.resetHistories();
        const std::vector<float> picture = denoise(*denoise::findDenoiser("svgf"), frame, settings);
        double sum = 0.0;
        for (size_t i = 0; i < picture.size(); ++i) sum += i % 4 == 3 ? 0.0 : double{picture[i]};
        return sum;
    }
};

TEST_P(LoneHairsTest, BrightHairsAreNotDimmed) {
    for (const uint32_t seed : {0u, 1u, 2u}) {
        const HostFrame frame = hairs(seed);
        const double kept =
            lightOfFirst(frame, denoise::SvgfSettings{}.fireflies) / lightOfFirst(frame, 0.0f);
        fmt::print("light of hairs: {:.3f} of that without dimming\n", kept);
        EXPECT_GT(kept, 0.95) << seed;
    }
}

TEST_P(LoneHairsTest, AFireflyAmidASurfaceIsDimmed) {
    HostFrame frame = frontalPlane(columns, rows);
    for (size_t i = 0; i < frame.diffuse.size(); ++i) frame.diffuse[i] = i % 4 == 3 ? 0.0f : 0.1f;
    const double steady = lightOfFirst(frame, 0.0f);
    for (size_t c = 0; c < 3; ++c)
        frame.diffuse[4 * (size_t{columns} * rows / 2 + columns / 2) + c] = 1000.0f;
    EXPECT_GT(lightOfFirst(frame, 0.0f), 1.3 * steady);
    EXPECT_NEAR(lightOfFirst(frame, denoise::SvgfSettings{}.fireflies) / steady, 1.0, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Backings, LoneHairsTest, testing::Values(gpu::Backing::Image, gpu::Backing::Buffer),
                         [](const auto& info) {
                             return info.param == gpu::Backing::Image ? "Images" : "Buffers";
                         });

}  // namespace
}  // namespace limpid::test
