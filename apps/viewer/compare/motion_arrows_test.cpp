#include "viewer/compare/motion_arrows.h"

#include <gtest/gtest.h>

namespace limpid::viewer {
namespace {

/// Every pixel of a 64x32 picture has moved by (x, y) pixels.
image::Image motion(float x, float y, float valid = 1.0f) {
    image::Image image(64, 32, 4);
    for (size_t at = 0; at < image.pixels.size(); at += 4) {
        image.pixels[at] = -x;
        image.pixels[at + 1] = -y;
        image.pixels[at + 3] = valid;
    }
    return image;
}

TEST(MotionArrows, GoFromWhereItWas) {
    const std::vector<Arrow> arrows = motionArrows(motion(3.0f, -1.0f), 128.0f, 64.0f);
    ASSERT_EQ(arrows.size(), 8u);
    EXPECT_EQ(arrows[0].to, vec2(16.0f, 16.0f));
    EXPECT_EQ(arrows[0].from, vec2(10.0f, 18.0f));  // the window has twice the picture's pixels
}

TEST(MotionArrows, HeadsPointTheWay) {
    const std::array<vec2, 3> head = arrowHead({vec2(0.0f, 10.0f), vec2(15.0f, 10.0f)});
    EXPECT_EQ(head[0], vec2(15.0f, 10.0f));
    EXPECT_EQ(head[1], vec2(9.0f, 13.0f));
    EXPECT_EQ(head[2], vec2(9.0f, 7.0f));
}

TEST(MotionArrows, RestAndWhatIsNotValidHaveNone) {
    EXPECT_TRUE(motionArrows(motion(0.1f, 0.1f), 128.0f, 64.0f).empty());
    EXPECT_TRUE(motionArrows(motion(5.0f, 0.0f, 0.0f), 128.0f, 64.0f).empty());
    EXPECT_TRUE(motionArrows({}, 128.0f, 64.0f).empty());
}

}  // namespace
}  // namespace limpid::viewer
