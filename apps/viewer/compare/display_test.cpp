#include "viewer/compare/display.h"

#include <gtest/gtest.h>

namespace limpid::viewer {
namespace {

TEST(SplitPanes, EachShowsItsOwnPart) {
    const auto panes = splitPanes({}, {}, {10, 10}, 0.52f);
    EXPECT_EQ(panes[0].source.left, 0.0f);
    EXPECT_EQ(panes[0].source.right, 0.5f);  // between two pixels
    EXPECT_EQ(panes[0].target.right, 0.5f);
    EXPECT_EQ(panes[1].source.left, 0.5f);
    EXPECT_EQ(panes[1].target.left, 0.5f);
    EXPECT_EQ(panes[1].source.right, 1.0f);
}

/// Checks a square in pixels of the picture and of the window.
void expectSquare(float x, float y) {
    const gpu::Extent picture{200, 100}, window{1000, 500};
    for (const int number : {0, 1}) {
        const gpu::Pane pane = magnified({}, picture, window, {x, y}, number);
        const float left = 200.0f * pane.source.left, top = 100.0f * pane.source.top;
        EXPECT_FLOAT_EQ(200.0f * pane.source.right - left, 21.0f);
        EXPECT_FLOAT_EQ(100.0f * pane.source.bottom - top, 21.0f);
        EXPECT_GE(left, 0.0f);
        EXPECT_LE(left, std::floor(x / 5.0f));
        EXPECT_GE(left + 21.0f, std::floor(x / 5.0f) + 1.0f);
        EXPECT_GE(pane.target.left, 0.0f);
        EXPECT_LE(pane.target.right, 1.0001f);
        EXPECT_GE(pane.target.top, 0.0f);
        EXPECT_LE(pane.target.bottom, 1.0001f);
        EXPECT_TRUE(pane.enlarge);
    }
}

TEST(Magnified, HoldsThePixelUnderTheMouseAndStaysInTheWindow) {
    for (const float x : {0.0f, 3.0f, 500.0f, 999.0f})
        for (const float y : {0.0f, 250.0f, 499.0f}) expectSquare(x, y);
}

TEST(Placed, APartOfTheAreaIsAPartOfTheWindow) {
    const gpu::Rectangle all = placed({}, {0.0f, 0.0f, 600.0f, 400.0f}, 1000.0f, 400.0f);
    EXPECT_FLOAT_EQ(all.right, 0.6f);
    EXPECT_FLOAT_EQ(all.bottom, 1.0f);
    const gpu::Rectangle part =
        placed({0.5f, 0.25f, 1.0f, 0.5f}, {100.0f, 40.0f, 600.0f, 200.0f}, 1000.0f, 400.0f);
    EXPECT_FLOAT_EQ(part.left, 0.4f);
    EXPECT_FLOAT_EQ(part.top, 0.225f);
    EXPECT_FLOAT_EQ(part.right, 0.7f);
    EXPECT_FLOAT_EQ(part.bottom, 0.35f);
}

TEST(Magnified, SquaresStandSideBySide) {
    const gpu::Pane first = magnified({}, {200, 100}, {1000, 500}, {300.0f, 100.0f}, 0),
                    second = magnified({}, {200, 100}, {1000, 500}, {300.0f, 100.0f}, 1);
    EXPECT_FLOAT_EQ(first.target.right, second.target.left);
    EXPECT_EQ(first.source.left, second.source.left);
}

}  // namespace
}  // namespace limpid::viewer
