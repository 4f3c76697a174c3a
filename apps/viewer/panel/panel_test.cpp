#include "viewer/panel/panel.h"

#include <gtest/gtest.h>

namespace limpid::viewer {
namespace {

TEST(PictureArea, IsWhatThePanelLeaves) {
    PanelState panel;
    EXPECT_EQ(pictureArea(panel, 1400.0f, 800.0f, 1.0f).width, 1000.0f);
    EXPECT_EQ(pictureArea(panel, 2000.0f, 800.0f, 2.0f).width, 1200.0f);
    panel.memory.panelWidth = 300.0f;
    EXPECT_EQ(pictureArea(panel, 1400.0f, 800.0f, 1.0f).width, 1100.0f);
    EXPECT_EQ(pictureArea(panel, 1400.0f, 800.0f, 1.0f).height, 800.0f);
    panel.shown = false;
    EXPECT_EQ(pictureArea(panel, 1400.0f, 800.0f, 1.0f).width, 1400.0f);
}

TEST(PictureArea, IsThatOfThePictureThatWasAskedFor) {
    const PanelState panel;
    for (const float width : {130.0f, 250.0f, 390.0f, 400.0f, 1280.0f})
        for (const float scale : {1.0f, 2.0f}) {
            const float beside = scale * panelWidthBeside(width / scale);
            EXPECT_EQ(pictureArea(panel, width + beside, 800.0f, scale).width, width) << scale;
        }
}

TEST(PictureArea, ThePanelGivesWayInSmallWindows) {
    const PanelState panel;
    EXPECT_GE(pictureArea(panel, 420.0f, 800.0f, 1.0f).width, 64.0f);
    EXPECT_LT(pictureArea(panel, 420.0f, 800.0f, 1.0f).width, 420.0f);
    EXPECT_EQ(pictureArea(panel, 600.0f, 800.0f, 1.0f).width, 300.0f);
    EXPECT_EQ(pictureArea(panel, 150.0f, 800.0f, 1.0f).width, 150.0f);
    EXPECT_EQ(pictureArea(panel, 1.0f, 1.0f, 1.0f).width, 1.0f);
}

}  // namespace
}  // namespace limpid::viewer
