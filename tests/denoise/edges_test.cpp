// Compares the passes that smooth edges with the version in double precision, and the result with what
// slanted borders cover of each pixel.
#include "denoise/stages/taa/edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/denoise/denoise_fixture.h"
#include "tests/oracle/double_denoise_fixture.h"
#include "tests/oracle/double_edges.h"

namespace limpid::test {
namespace {

class EdgesTest : public DenoiseTest {
  protected:
    std::vector<dvec3> smoothed(const HostFrame& frame, const std::vector<float>& beauty, uint32_t reach,
                                gpu::Backing filters = gpu::Backing::Image) {
        graph_.beginFrame();
        denoise::DenoiserInput input = denoise::upload(graph_, frame);
        input.filters = filters;
        const gpu::ImageHandle picture =
            graph_.transient("picture", gpu::Format::RGBA32Float, {frame.width, frame.height});
        graph_.upload(picture, gpu::bytesOf(beauty));
        const gpu::ImageHandle result = denoise::smoothEdges(graph_, input, picture, reach);
        graph_.execute(device());
        std::vector<dvec3> colors;
        for (const dvec4& c : download(result)) colors.emplace_back(c);
        return colors;
    }

    /// The number of pixels that the passes changed.
    size_t compare(const HostFrame& frame, uint32_t reach, gpu::Backing filters) {
        std::vector<float> beauty(frame.diffuse.size(), 1.0f);
        for (size_t i = 0; i < beauty.size(); ++i)
            if (i % 4 != 3) beauty[i] = frame.diffuse[i] + frame.specular[i] + frame.emission[i];
        const std::vector<dvec3> expected = smoothedEdges(frame, beauty, reach);
        const std::vector<dvec3> is = smoothed(frame, beauty, reach, filters);
        const double rounding = filters == gpu::Backing::Buffer ? 1e-3 : 1e-5;
        size_t wrong = 0, changed = 0;
        for (size_t p = 0; p < expected.size(); ++p) {
            const dvec3 own(beauty[4 * p], beauty[4 * p + 1], beauty[4 * p + 2]);
            const dvec3 tolerance = rounding * (1.0 + expected[p]) * (1.0 + expected[p]);
            wrong += glm::any(glm::greaterThan(glm::abs(is[p] - expected[p]), tolerance));
            changed += glm::distance(expected[p], own) > 1e-3;
        }
        EXPECT_LE(wrong, expected.size() / 1000) << "some decisions may be close";
        return changed;
    }
};

TEST_F(EdgesTest, AgreeWithTheFormulasInDouble) {
    const SyntheticScene scene({.cameraMoves = true, .objectMoves = true});
    for (const gpu::Backing filters : {gpu::Backing::Image, gpu::Backing::Buffer})
        for (const uint32_t reach : {1u, 3u, 8u}) {
            SCOPED_TRACE(reach);
            EXPECT_GT(compare(scene.frame(3, 101, 57, 7), reach, filters), 20u);
            compare(scene.frame(4, 3, 2, 7), reach, filters);
            compare(scene.frame(4, 1, 40, 7), reach, filters);
        }
}

TEST_F(EdgesTest, WhatIsNotFiniteIsNoEdge) {
    HostFrame frame = frontalPlane(8, 8);
    for (const size_t p : {9u, 30u}) frame.normal[4 * p] = std::numeric_limits<float>::quiet_NaN();
    frame.normal[4 * 42 + 1] = std::numeric_limits<float>::infinity();
    std::vector<float> beauty;
    for (size_t p = 0; p < 64; ++p) beauty.insert(beauty.end(), {0.1f * static_cast<float>(p % 7), 1, 0, 1});
    const std::vector<dvec3> is = smoothed(frame, beauty, 8);
    for (size_t p = 0; p < 64; ++p) EXPECT_EQ(is[p].x, double{beauty[4 * p]}) << p;
}

/// Two surfaces with a straight border, white and black; only their distances tell of it.
struct Slanted {
    static constexpr uint32_t side = 48;
    double slope;
    bool across;  ///< the border is more upright than level

    bool isFar(double x, double y) const { return across ? x > 20.3 + slope * y : y > 20.3 + slope * x; }
    HostFrame frame() const {
        HostFrame frame = frontalPlane(side, side);
        for (uint32_t p = 0; p < side * side; ++p)
            if (isFar(p % side + 0.5, p / side + 0.5)) frame.depth[4 * p] = 4.0f;
        return frame;
    }
    double covered(uint32_t p) const {
        constexpr int points = 16;
        int count = 0;
        for (int i = 0; i < points * points; ++i)
            count += isFar(p % side + (i % points + 0.5) / points, p / side + (i / points + 0.5) / points);
        return static_cast<double>(count) / (points * points);
    }
};

/// The mean over the pixel, in the colours that are averaged: E(1) is half of white.
TEST_F(EdgesTest, SlantedBordersCoverPixelsByTheirArea) {
    for (const bool across : {false, true})
        for (const double slope : {0.13, -0.31, 0.5}) {
            SCOPED_TRACE(slope);
            const Slanted border{slope, across};
            const HostFrame frame = border.frame();
            std::vector<float> beauty;
            for (size_t p = 0; p < frame.pixelCount(); ++p) {
                const float value = frame.depth[4 * p] > 3.0f ? 1.0f : 0.0f;
                beauty.insert(beauty.end(), {value, value, value, 1});
            }
            const std::vector<dvec3> is = smoothed(frame, beauty, 16);
            double before = 0.0, after = 0.0;
            for (uint32_t p = 0; p < frame.pixelCount(); ++p) {
                const double x = is[p].x / (1.0 + is[p].x) / 0.5;  // the share of white in E
                before += std::pow(double{beauty[4 * p]} - border.covered(p), 2);
                after += std::pow(x - border.covered(p), 2);
            }
            // Stairs of two pixels tell less of where the border lies between them.
            EXPECT_LT(after, (std::abs(slope) < 0.4 ? 0.2 : 0.4) * before);
        }
}

/// Textures and shadows are not geometry.
TEST_F(EdgesTest, LightAloneIsNoEdge) {
    const HostFrame frame = frontalPlane(16, 16);
    std::vector<float> beauty;
    for (size_t p = 0; p < 256; ++p) {
        const float value = p % 16 > p / 16 ? 1.0f : 0.0f;
        beauty.insert(beauty.end(), {value, value, value, 1});
    }
    const std::vector<dvec3> is = smoothed(frame, beauty, 8);
    for (size_t p = 0; p < 256; ++p) EXPECT_EQ(is[p].x, double{beauty[4 * p]});
}

}  // namespace
}  // namespace limpid::test
