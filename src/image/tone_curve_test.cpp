// Tests the tone curves against their formulas in double precision, written down independently.
#include "image/tone_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "base/error.h"

namespace limpid::image {
namespace {

using Color = std::array<double, 3>;

/// Rows, as the article prints the inset matrix transposed.
Color times(const std::array<Color, 3>& rows, const Color& v) {
    Color result{};
    for (size_t r = 0; r < 3; ++r)
        for (size_t c = 0; c < 3; ++c) result[r] += rows[r][c] * v[c];
    return result;
}

Color agxInDouble(const Color& exposed) {
    const std::array<Color, 3> inset{{{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                                      {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                                      {0.0423756549057051, 0.0784336, 0.879142973793104}}};
    const std::array<Color, 3> outset{{{1.19687900512017, -0.0980208811401368, -0.0990297440797205},
                                       {-0.0528968517574562, 1.15190312990417, -0.0989611768448433},
                                       {-0.0529716355144438, -0.0980434501171241, 1.15107367264116}}};
    Color value = times(inset, exposed);
    for (double& v : value) {
        const double x =
            std::clamp((std::log2(std::max(v, 1e-10)) + 12.47393) / (4.026069 + 12.47393), 0.0, 1.0);
        v = 15.5 * std::pow(x, 6) - 40.14 * std::pow(x, 5) + 31.96 * std::pow(x, 4) - 6.868 * x * x * x +
            0.4298 * x * x + 0.1191 * x - 0.00232;
    }
    value = times(outset, value);
    for (double& v : value) v = std::clamp(v, 0.0, 1.0);
    return value;
}

TEST(ToneCurve, AgxIsItsFormula) {
    std::mt19937 generator(5);
    std::uniform_real_distribution<float> stops(-16.0f, 8.0f);
    for (int i = 0; i < 5000; ++i) {
        const vec3 color(std::exp2(stops(generator)), std::exp2(stops(generator)),
                         std::exp2(stops(generator)));
        const vec3 shown = displayColor(ToneCurve::Agx, color);
        const Color expected = agxInDouble({double{color.r}, double{color.g}, double{color.b}});
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(double{shown[c]}, expected[static_cast<size_t>(c)], 2e-5) << i;
    }
}

/// What AgX is for: greys stay grey, middle grey stays near the middle, and bright colours turn white.
TEST(ToneCurve, AgxKeepsGreysAndWhitensWhatIsBright) {
    const vec3 grey = displayColor(ToneCurve::Agx, vec3(0.18f));
    EXPECT_NEAR(grey.r, grey.g, 2e-3f);
    EXPECT_NEAR(grey.g, grey.b, 2e-3f);
    EXPECT_NEAR(grey.g, 0.5f, 0.005f);  // where the sigmoid has its pivot
    float previous = -1.0f;
    for (float x = 1e-5f; x < 100.0f; x *= 1.05f) {
        const float y = displayColor(ToneCurve::Agx, vec3(x)).g;
        ASSERT_GE(y, previous - 1e-4f) << x;
        previous = y;
    }
    const vec3 red = displayColor(ToneCurve::Agx, {0.5f, 0.0f, 0.0f}),
               bright = displayColor(ToneCurve::Agx, {500.0f, 0.0f, 0.0f});
    EXPECT_LT(red.g / red.r, 0.5f);
    EXPECT_GT(bright.g / bright.r, 0.7f);
}

TEST(ToneCurve, NoneClips) {
    const vec3 shown = displayColor(ToneCurve::None, {0.5f, 2.0f, -1.0f});
    EXPECT_NEAR(shown.r, 0.735357f, 1e-5f);
    EXPECT_EQ(shown.g, 1.0f);
    EXPECT_EQ(shown.b, 0.0f);
}

TEST(ToneCurve, FalseColorsCountStopsFromMiddleGrey) {
    for (int stops = -9; stops <= 9; ++stops) {
        for (const float off : {-0.45f, 0.0f, 0.45f}) {
            const vec3 shown =
                displayColor(ToneCurve::FalseColor, vec3(0.18f * std::exp2(static_cast<float>(stops) + off)));
            const auto band = static_cast<size_t>(std::clamp(stops, -6, 6) + 6);
            EXPECT_EQ(shown, falseColors()[band]) << stops << " " << off;
        }
    }
    // Luminance counts: a pure green of 0.18 / 0.7152 is middle grey.
    EXPECT_EQ(displayColor(ToneCurve::FalseColor, {0.0f, 0.2517f, 0.0f}), falseColors()[6]);
}

TEST(ToneCurve, EveryInputHasAColor) {
    const float special[] = {
        0.0f,  -1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        1e38f, 1e-38f};
    for (size_t i = 0; i < toneCurveNames().size(); ++i) {
        for (const float value : special) {
            const vec3 shown = displayColor(static_cast<ToneCurve>(i), vec3(value, 0.5f, 0.0f));
            for (int c = 0; c < 3; ++c) {
                EXPECT_GE(shown[c], 0.0f) << toneCurveNames()[i] << " " << value;
                EXPECT_LE(shown[c], 1.0f) << toneCurveNames()[i] << " " << value;
            }
        }
    }
}

TEST(ToneCurve, HasNames) {
    for (size_t i = 0; i < toneCurveNames().size(); ++i)
        EXPECT_EQ(nameOf(parseToneCurve(toneCurveNames()[i])), toneCurveNames()[i]);
    EXPECT_THROW(parseToneCurve("aces"), UsageError);
}

/// As `none` up to 1, and sRGB's formula beyond it up to the largest value.
TEST(ToneCurve, ExtendedContinuesAboveWhite) {
    const vec3 below(0.0f, 0.18f, 1.0f);
    EXPECT_EQ(extendedColor(below), displayColor(ToneCurve::None, below));
    const auto formula = [](double linear) { return 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055; };
    const vec3 above = extendedColor({2.0f, 30.0f, 1e6f});
    EXPECT_NEAR(double{above.r}, formula(2.0), 1e-5);
    EXPECT_NEAR(double{above.g}, formula(30.0), 1e-5);
    EXPECT_NEAR(double{above.b}, formula(125.0), 1e-5);
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(extendedColor({nan, -3.0f, 0.0f}), vec3(0.0f));
}

}  // namespace
}  // namespace limpid::image
