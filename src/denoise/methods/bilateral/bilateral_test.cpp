// The joint bilateral filter against the formula of bilateral.h in double precision. What holds of every
// denoiser is in tests/denoise/denoiser_suite_test.cpp.
#include "denoise/methods/bilateral/bilateral.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/denoise/denoise_fixture.h"
#include "tests/oracle/double_denoise_fixture.h"

namespace limpid::test {
namespace {

constexpr uint32_t columns = 40, rows = 24;

class BilateralTest : public DenoiseTest {};

/// The filter at pixel `p`: an independent version of the formula.
dvec3 filteredAt(const HostFrame& frame, const denoise::BilateralSettings& s, size_t p) {
    const DoubleFrame pixels(frame);
    const auto point = [&](size_t q) { return pixels.distance(q) * glm::normalize(pixels.ray(q)); };
    const double sigma = 0.5 * s.radius;
    const auto px = static_cast<int>(p % columns), py = static_cast<int>(p / columns);
    dvec3 sum(0.0);
    double weights = 0.0;
    for (size_t q = 0; q < frame.pixelCount(); ++q) {
        const int x = static_cast<int>(q % columns) - px, y = static_cast<int>(q / columns) - py;
        if (std::max(std::abs(x), std::abs(y)) > s.radius || !pixels.hit(q)) continue;
        const dvec3 n = pixels.normal(p);
        const double deviation = std::abs(glm::dot(point(q) - point(p), n));
        const double weight = std::exp(-(x * x + y * y) / (2.0 * sigma * sigma)) *
                              std::pow(std::max(glm::dot(n, pixels.normal(q)), 0.0), s.normalPower) *
                              std::exp(-deviation / (s.plane * pixels.distance(p)));
        sum += weight * pixels.scattered(q) / glm::max(pixels.albedo(q), double{s.minAlbedo});
        weights += weight;
    }
    return sum / weights * glm::max(pixels.albedo(p), double{s.minAlbedo}) + pixels.emission(p);
}

TEST_F(BilateralTest, IsTheFormula) {
    const HostFrame frame = SyntheticScene({}).frame(0, columns, rows, 1);
    DenoiserSettings settings;
    settings.bilateral = {.radius = 3, .normalPower = 8.0f, .plane = 0.05f};
    const std::vector<float> picture = denoise(*denoise::findDenoiser("bilateral"), frame, settings);
    const DoubleFrame pixels(frame);
    int compared = 0;
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        if (!pixels.hit(p)) continue;
        const dvec3 expected = filteredAt(frame, settings.bilateral, p);
        for (size_t c = 0; c < 3; ++c)
            ASSERT_NEAR(picture[4 * p + c], expected[static_cast<int>(c)],
                        1e-4 * (1.0 + expected[static_cast<int>(c)]))
                << "pixel " << p;
        ++compared;
    }
    EXPECT_GT(compared, 300);
}

}  // namespace
}  // namespace limpid::test
