// Tests what the oracle of SVGF does to pixels with a short history, with numbers computed by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/oracle/double_denoise_fixture.h"
#include "tests/oracle/svgf/double_svgf.h"

namespace limpid::test {
namespace {

using denoise::HostFrame;

/// The middle of five by five pixels of a plane.
class SvgfYoungByHand : public testing::Test {
  protected:
    static constexpr size_t middle = 12;
    HostFrame frame = frontalPlane(5, 5);
    SvgfSurfaces surfaces = svgfSurfaces(frame);
    std::vector<dvec4> color{25, dvec4(2, 2, 2, 0.5)}, moments{25, dvec4(1, 1, 1, 3)};
    DoubleSvgfParams params{.phiColor = 4.0, .phiDepth = 1e9};
};

TEST_F(SvgfYoungByHand, AFireflyIsDimmedToTheLimitOfItsNeighbours) {
    for (const size_t other : {6, 8, 16, 18}) moments[other].x = 3.0;  // mean 2, deviation 1
    moments[0].x = 1e6;                                                // out of reach
    color[middle] = dvec4(20, 20, 20, 10);
    params.fireflies = 2.0;
    const auto factor = [&](double frames) {
        moments[middle] = dvec4(20, 400, 20, frames);
        const SvgfDimming dimming = svgfDimming(frame, SvgfSignal::Diffuse, surfaces, color, moments, params);
        EXPECT_LE(dimming.least[middle], dimming.factor[middle]);
        EXPECT_GE(dimming.most[middle], dimming.factor[middle]);
        EXPECT_LT(dimming.most[middle] - dimming.least[middle], 1e-4);
        return dimming.factor[middle];
    };
    EXPECT_NEAR(factor(1), (2 + 2 * 1 + 0.002 + 1e-6) / 20, 1e-9);
    EXPECT_NEAR(factor(2), (2 + 2 * 4 + 0.002 + 1e-6) / 20, 1e-9);
    EXPECT_EQ(factor(3.5), 1.0) << "2 + 24.5";
    params.fireflies = 0.01;
    EXPECT_LT(factor(3.9), 0.2);
    EXPECT_EQ(factor(4), 1.0);
    params.fireflies = 2.0;
    color[middle].w = 1.0;  // its own noise explains 4
    EXPECT_NEAR(factor(1), 16.0 / 20, 1e-9);
    color[middle].w = 10.0;
    moments[6].w = 0.0;  // no light: one of 3 less
    const double mean = 13.0 / 7, deviation = std::sqrt(31.0 / 7 - mean * mean);
    EXPECT_NEAR(factor(1), (mean * 1.001 + 2 * deviation + 1e-6) / 20, 1e-9);
    params.fireflies = 0.0;
    EXPECT_EQ(factor(1), 1.0);
}

TEST_F(SvgfYoungByHand, DarkAndNegativeLightIsNeverDimmed) {
    params.fireflies = 2.0;
    for (dvec4& m : moments) m = dvec4(-1, 1, -1, 1);
    const auto factor = [&](double light) {
        color[middle] = dvec4(dvec3(light), 1);
        return svgfDimming(frame, SvgfSignal::Diffuse, surfaces, color, moments, params).factor[middle];
    };
    for (const double light : {-2.0, -0.5, 0.0, 9e-7}) EXPECT_EQ(factor(light), 1.0) << light;
    EXPECT_NEAR(factor(1e-4), 0.01, 1e-9) << "never brighter, nor of the other sign";
}

TEST_F(SvgfYoungByHand, APixelWithoutNeighboursIsNotDimmed) {
    for (dvec3& normal : surfaces.normal) normal = {1, 0, 0};
    surfaces.normal[middle] = {0, 0, 1};
    color[middle] = dvec4(20, 20, 20, 10);
    params.fireflies = 2.0;
    EXPECT_EQ(svgfDimming(frame, SvgfSignal::Diffuse, surfaces, color, moments, params).factor[middle], 1.0);
}

TEST_F(SvgfYoungByHand, OneNeighbourDoesNotTellAFirefly) {
    const dvec3 other(1, 0, 0), same(0, 0, 1);
    for (dvec3& normal : surfaces.normal) normal = other;
    surfaces.normal[middle] = surfaces.normal[middle - 1] = same;
    color[middle] = dvec4(20, 20, 20, 10);
    params.fireflies = 2.0;
    const auto dimming = [&] {
        return svgfDimming(frame, SvgfSignal::Diffuse, surfaces, color, moments, params);
    };
    EXPECT_EQ(dimming().factor[middle], 1.0);
    // Another one with the weight w: (1 + w)^2 = 1.5 (1 + w^2) for w = 2 - sqrt(3) = 0.268.
    const auto weighs = [&](double w) {
        const double cosine = 1.0 + std::log(w) / params.phiNormal;
        surfaces.normal[middle + 1] = {std::sqrt(1.0 - cosine * cosine), 0.0, cosine};
    };
    weighs(0.26);
    EXPECT_EQ(dimming().factor[middle], 1.0);
    EXPECT_EQ(dimming().least[middle], 1.0);
    weighs(0.268);
    EXPECT_LT(dimming().least[middle], 0.06) << "float32 may dim it, or not";
    EXPECT_EQ(dimming().most[middle], 1.0);
    weighs(0.28);
    EXPECT_NEAR(dimming().factor[middle], 1.001 / 20, 1e-6);
    EXPECT_LT(dimming().most[middle], 0.06);
    for (const size_t next : {middle - 1, middle + 1}) surfaces.normal[next] = {0.6, 0, 0.8};
    EXPECT_EQ(dimming().factor[middle], 1.0) << "both show another surface";
    // Slanted or curved surfaces: both are as little like it, but there are two of them.
    for (const size_t next : {middle - 1, middle + 1}) {
        weighs(0.01);
        surfaces.normal[next] = surfaces.normal[middle + 1];
    }
    EXPECT_NEAR(dimming().factor[middle], 1.001 / 20, 1e-6);
}

TEST_F(SvgfYoungByHand, FillingWeighsPixelsByTheirFrames) {
    const auto filled = [&](double frames) {
        color[middle] = dvec4(1, 1, 1, 1);
        moments[middle].w = frames;
        std::vector<dvec4> filtered(25, dvec4(-9));
        svgfFillYoung(frame, SvgfSignal::Diffuse, surfaces, color, moments, params, filtered);
        return filtered[middle];
    };
    EXPECT_EQ(filled(1), dvec4(-9));
    params.youngRadius = 1;
    const double sigma = std::sqrt(16 + 4 * 36 * 0.25 + 4 * 9 * 0.25) / 40;
    EXPECT_LT(glm::distance(filled(1), dvec4(dvec3((4 + 36 * 2.0) / 40), sigma)), 1e-6);
    EXPECT_NEAR(filled(0).x, 2.0, 1e-6) << "no light of its own";
    EXPECT_EQ(filled(4), dvec4(-9)) << "old enough";
    params.youngRadius = 2;
    const double all = 9 + 3 * (81 - 9);
    EXPECT_NEAR(filled(1).x, (9 + (all - 9) * 2) / all, 1e-6);
    EXPECT_NEAR(filled(1.5).x, (6 + 36 * 2.0) / 42, 1e-6) << "a radius of 1";
    EXPECT_NEAR(filled(3).x, (12 + 36 * 2.0) / 48, 1e-6);
    for (dvec4& m : moments) m.w = 0.0;
    EXPECT_EQ(filled(0), dvec4(-9)) << "nothing to fill it with";
}

}  // namespace
}  // namespace limpid::test
