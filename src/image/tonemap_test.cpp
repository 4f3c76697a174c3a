#include "image/tonemap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "image/color.h"

namespace limpid::image {
namespace {

TEST(Srgb, KnownValuesAndInverse) {
    EXPECT_EQ(srgbEncode(0.0f), 0.0f);
    EXPECT_EQ(srgbEncode(1.0f), 1.0f);
    EXPECT_EQ(srgbDecode(1.0f), 1.0f);
    EXPECT_NEAR(srgbEncode(0.5f), 0.735357f, 1e-5f);
    EXPECT_NEAR(srgbEncode(0.0031308f), 0.04045f, 1e-5f);
    EXPECT_NEAR(srgbEncode(0.001f), 0.01292f, 1e-7f);
    EXPECT_NEAR(srgbDecode(0.5f), 0.214041f, 1e-5f);
    for (int i = 0; i <= 4096; ++i) {
        const float x = static_cast<float>(i) / 4096.0f;
        ASSERT_NEAR(srgbDecode(srgbEncode(x)), x, 2e-6f);
        ASSERT_EQ(srgbEncode(-x), -srgbEncode(x));
    }
}

TEST(FilmicCurve, IsMonotoneFrom0To1) {
    EXPECT_EQ(filmicCurve(0.0f), 0.0f);
    EXPECT_EQ(filmicCurve(-1.0f), 0.0f);
    EXPECT_EQ(filmicCurve(std::nanf("")), 0.0f);
    EXPECT_EQ(filmicCurve(std::numeric_limits<float>::infinity()), 1.0f);
    EXPECT_EQ(filmicCurve(std::numeric_limits<float>::max()), 1.0f);
    // x = 0.6: (0.6 (1.506 + 0.03)) / (0.6 (1.458 + 0.59) + 0.14)
    EXPECT_NEAR(filmicCurve(1.0f), 0.9216f / 1.3688f, 1e-6f);
    float previous = 0.0f;
    for (float x = 1e-6f; x < 1e6f; x *= 1.01f) {
        const float y = filmicCurve(x);
        ASSERT_GE(y, previous) << x;
        ASSERT_LE(y, 1.0f);
        previous = y;
    }
}

TEST(AutoExposure, BringsTheAverageToTheKey) {
    EXPECT_NEAR(autoExposure(Image(8, 8, 3, 0.18f)), 0.0f, 1e-5f);
    EXPECT_NEAR(autoExposure(Image(8, 8, 4, 0.72f)), -2.0f, 1e-5f);
    EXPECT_NEAR(autoExposure(Image(8, 8, 1, 0.09f)), 1.0f, 1e-5f);
    Image image(2, 1, 3, 0.09f);
    for (uint32_t c = 0; c < 3; ++c) image.at(1, 0, c) = 0.36f;
    EXPECT_NEAR(autoExposure(image), 0.0f, 1e-5f) << "the geometric mean";
}

TEST(AutoExposure, IsMeteredOnTheSubject) {
    Image image(4, 1, 3, 100.0f);  // a bright sky, and one pixel of an object
    for (uint32_t c = 0; c < 3; ++c) image.at(2, 0, c) = 0.045f;
    const std::vector<float> subject{0.0f, 0.4f, 0.6f, 0.0f};
    EXPECT_NEAR(autoExposure(image, subject), 2.0f, 1e-5f);
    EXPECT_LT(autoExposure(image), -4.0f);
    EXPECT_EQ(autoExposure(image, std::vector<float>(4, 0.0f)), autoExposure(image)) << "nothing but sky";
    EXPECT_EQ(autoExposure(image, std::vector<float>(4, 1.0f)), autoExposure(image)) << "no sky";
}

TEST(AutoExposure, IgnoresBlackAndInvalidPixels) {
    EXPECT_EQ(autoExposure(Image(8, 8, 3)), 0.0f);
    EXPECT_EQ(autoExposure(Image()), 0.0f);
    EXPECT_EQ(autoExposure(Image(2, 2, 3, std::nanf(""))), 0.0f);
    Image image(4, 4, 3);
    for (uint32_t c = 0; c < 3; ++c) {
        image.at(0, 0, c) = 0.18f;
        image.at(1, 0, c) = std::nanf("");
        image.at(2, 0, c) = std::numeric_limits<float>::infinity();
        image.at(3, 0, c) = -5.0f;
        image.at(0, 1, c) = 1e-30f;
    }
    EXPECT_NEAR(autoExposure(image), 0.0f, 1e-5f);
    EXPECT_EQ(autoExposure(Image(2, 2, 3, 1e-35f)), 40.0f);
}

TEST(Tonemap, ExposesEncodesAndKeepsAlpha) {
    Image image(1, 1, 4, 0.25f);
    const Image view = tonemap(image, 2.0f);
    EXPECT_FLOAT_EQ(view.at(0, 0, 0), srgbEncode(filmicCurve(1.0f)));
    EXPECT_EQ(view.at(0, 0, 3), 0.25f);
    EXPECT_EQ(tonemap(Image(3, 2, 1, 1.0f), 0.0f).components, 1u);
    EXPECT_EQ(tonemap(Image(1, 1, 3, std::nanf("")), 0.0f).pixels, (std::vector<float>(3, 0.0f)));
}

TEST(Tonemap, FilmicCurveHasAnInverse) {
    EXPECT_EQ(filmicCurveInverse(0.0), 0.0);
    for (const double display : {0.001, 0.18, 0.5, 0.85, 0.999})
        EXPECT_NEAR(filmicCurve(static_cast<float>(filmicCurveInverse(display))), display, 1e-6);
}

TEST(Tonemap, ASequenceHasOneExposure) {
    EXPECT_EQ(measuredExposure(Image(2, 2, 3, 0.0f)), std::nullopt);
    // Averages 0.18 * 2^-3 and 0.18 * 2^1: their geometric mean is one stop below 0.18. The black frame does
    // not count.
    const std::vector<std::optional<float>> frames = {measuredExposure(Image(2, 2, 3, 0.0225f)),
                                                      measuredExposure(Image(2, 2, 3, 0.36f)),
                                                      measuredExposure(Image(2, 2, 3, 0.0f))};
    EXPECT_NEAR(sequenceExposure(frames), 1.0f, 1e-5);
    EXPECT_EQ(sequenceExposure(std::vector<std::optional<float>>{std::nullopt}), 0.0f);
    EXPECT_EQ(sequenceExposure({}), 0.0f);
}

}  // namespace
}  // namespace limpid::image
