#include "studio/compare/inspector.h"

#include <gtest/gtest.h>

#include <limits>

namespace limpid::studio {
namespace {

image::Image pixel(std::vector<float> values) {
    image::Image picture(1, 1, static_cast<uint32_t>(values.size()));
    picture.pixels = std::move(values);
    return picture;
}

uint32_t texel(std::vector<float> values, const InspectorView& view = {}) {
    return shownTexels(pixel(std::move(values)), view).at(0);
}

TEST(Inspector, ColorsAreEncoded) {
    EXPECT_EQ(texel({1.0f, 0.0f, 0.0f, 0.5f}), 0xFF0000FFu);
    EXPECT_EQ(texel({0.0f, 1.0f, 0.0f}), 0xFF00FF00u);
    EXPECT_EQ(texel({0.0f, 0.0f, 7.0f}), 0xFFFF0000u);
    EXPECT_EQ(texel({-1.0f, -1.0f, -1.0f}), 0xFF000000u);
    EXPECT_EQ(texel({0.5f}), 0xFFBCBCBCu);  // 0.5 is 188 in sRGB
    EXPECT_EQ(texel({0.25f}, {.stops = 1.0f}), 0xFFBCBCBCu);
}

TEST(Inspector, OneChannelIsGrey) {
    EXPECT_EQ(texel({0.0f, 0.0f, 1.0f, 0.0f}, {.channels = InspectorView::Blue}), 0xFFFFFFFFu);
    EXPECT_EQ(texel({0.0f, 0.0f, 0.0f, 1.0f}, {.channels = InspectorView::Alpha}), 0xFFFFFFFFu);
    EXPECT_EQ(texel({1.0f, 0.0f}, {.channels = InspectorView::Alpha}), 0xFF000000u);
}

TEST(Inspector, FalseColorsGetBrighter) {
    const uint32_t dark = texel({0.0f}, {.falseColor = true}), bright = texel({1.0f}, {.falseColor = true});
    EXPECT_LT(dark & 0xFFu, 16u);
    EXPECT_GT(bright & 0xFFu, 240u);
}

TEST(Inspector, WhatIsNoNumberStandsOut) {
    EXPECT_EQ(texel({std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f}), 0xFFFF00FFu);
    EXPECT_EQ(texel({std::numeric_limits<float>::infinity()}, {.falseColor = true}), 0xFFFF00FFu);
}

}  // namespace
}  // namespace limpid::studio
