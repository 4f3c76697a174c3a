#include "viewer/panel/sections.h"

#include <gtest/gtest.h>

namespace limpid::viewer {
namespace {

TEST(Search, FindsEveryWordInAnyText) {
    EXPECT_TRUE(matches("Levels", {"levels", "svgf.levels"}));
    EXPECT_TRUE(matches("svgf lev", {"levels", "svgf.levels"}));
    EXPECT_TRUE(matches("noise path", {"seed", "another seed gives other noise", "Pathtracer"}));
    EXPECT_FALSE(matches("noise glass", {"seed", "another seed gives other noise"}));
    EXPECT_TRUE(matches("", {"seed"}));
    EXPECT_TRUE(matches("  seed ", {"seed"}));
}

TEST(PictureArea, IsWhatThePanelLeaves) {
    PanelState panel;
    EXPECT_EQ(pictureArea(panel, 1400.0f, 800.0f, 1.0f).width, 1000.0f);
    EXPECT_EQ(pictureArea(panel, 1400.0f, 800.0f, 2.0f).width, 600.0f);
    panel.memory.panelWidth = 300.0f;
    EXPECT_EQ(pictureArea(panel, 1400.0f, 800.0f, 1.0f).width, 1100.0f);
    EXPECT_EQ(pictureArea(panel, 1400.0f, 800.0f, 1.0f).height, 800.0f);
    panel.shown = false;
    EXPECT_EQ(pictureArea(panel, 1400.0f, 800.0f, 1.0f).width, 1400.0f);
}

TEST(PictureArea, ThePanelGivesWayInSmallWindows) {
    const PanelState panel;
    EXPECT_GE(pictureArea(panel, 420.0f, 800.0f, 1.0f).width, 64.0f);
    EXPECT_LT(pictureArea(panel, 420.0f, 800.0f, 1.0f).width, 420.0f);
    EXPECT_EQ(pictureArea(panel, 150.0f, 800.0f, 1.0f).width, 150.0f);
    EXPECT_EQ(pictureArea(panel, 1.0f, 1.0f, 1.0f).width, 1.0f);
}

}  // namespace
}  // namespace limpid::viewer
