#include "shot/run/keep_input.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace limpid::shot {
namespace {

using image::Image;

constexpr uint32_t side = 64;

Image noiseAround(float mean, float deviation) {
    Image picture(side, side, 3);
    std::mt19937 random(3);
    std::normal_distribution<float> noise(mean, deviation);
    for (float& value : picture.pixels) value = noise(random);
    return picture;
}

std::vector<float> flat(float value) {
    return std::vector<float>(4 * side * side, value);
}

TEST(KeepInput, StrengthMixesAndLeavesOutWhatIsNotFinite) {
    Image noisy = noiseAround(1.0f, 0.2f);
    noisy.pixels[3] = NAN;
    std::vector<float> clean = flat(2.0f);
    mix(clean, noisy, 0.25f);
    EXPECT_FLOAT_EQ(clean[0], 0.75f * noisy.pixels[0] + 0.5f);
    EXPECT_FLOAT_EQ(clean[4], 2.0f);
    EXPECT_FLOAT_EQ(clean[3], 2.0f);  // alpha
}

TEST(KeepInput, NothingIsRestoredWhereNothingWasFilteredAway) {
    const Image noisy(side, side, 3, 0.7f);
    std::vector<float> clean = flat(0.7f);
    restoreDetail(clean, noisy, 1.0f);
    EXPECT_EQ(clean, flat(0.7f));
}

TEST(KeepInput, OfNoiseSevenPercentOfTheVarianceReturn) {
    const Image noisy = noiseAround(5.0f, 0.3f);
    std::vector<float> clean = flat(5.0f);
    restoreDetail(clean, noisy, 1.0f);
    double sum = 0.0;
    for (size_t i = 0; i < clean.size(); ++i)
        if (i % 4 != 3) sum += std::pow(static_cast<double>(clean[i]) - 5.0, 2.0);
    const double share = sum / (3.0 * side * side) / (0.3 * 0.3);
    const double expected = std::pow((1 + 16 + 36 + 16 + 1) / 256.0, 2.0);  // without borders
    EXPECT_NEAR(share, expected, 0.15 * expected);
}

TEST(KeepInput, AFaintStripeThatWasFilteredAwayReturnsByItsShare) {
    Image noisy(side, side, 3, 1.0f);
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 24; x < 40; ++x)
            for (uint32_t c = 0; c < 3; ++c) noisy.at(x, y, c) = 1.5f;
    std::vector<float> clean = flat(1.0f);
    restoreDetail(clean, noisy, 0.5f);
    EXPECT_NEAR(clean[4 * (32 * side + 32)], 1.25f, 1e-5f);
    EXPECT_NEAR(clean[4 * (32 * side + 8)], 1.0f, 1e-5f);
}

TEST(KeepInput, AFireflyDoesNotComeBack) {
    Image noisy = noiseAround(1.0f, 0.1f);
    noisy.at(30, 30, 0) = 10000.0f;
    std::vector<float> clean = flat(1.0f);
    restoreDetail(clean, noisy, 1.0f);
    EXPECT_NEAR(clean[4 * (30 * side + 30)], 1.0f, 0.2f);
}

}  // namespace
}  // namespace limpid::shot
