#include "shot/camera/camera_track.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "image/io/temp_folder.h"

namespace limpid::shot {
namespace {

using testing::HasSubstr;

class CameraTrackTest : public testing::Test {
  protected:
    CameraTrack read(const std::string& text) {
        image::test::put(folder_ / "cameras.json", text);
        return CameraTrack::read(folder_ / "cameras.json");
    }
    std::string messageOf(const std::string& text) {
        try {
            read(text);
        } catch (const InputError& error) {
            return error.what();
        }
        return "none";
    }
    static std::string frame(const std::string& members, const std::string& key = "1") {
        return R"({"frames": {")" + key + R"(": {"eye": [1, 2, 3], "forward": [0, 2, 0], "up": [0, 0, 1])" +
               members + "}}}";
    }
    image::test::TempFolder folder_;
};

TEST_F(CameraTrackTest, ACameraBecomesRaysThroughThePicturesBorders) {
    const CameraTrack track =
        read(frame(R"(, "fov_y": 90, "orthographic_height": null, "shift": [0.25, 0])", "7"));
    EXPECT_FALSE(track.at(1));
    ASSERT_TRUE(track.at(7));
    const CameraParams camera = track.at(7)->params(200, 100);
    EXPECT_EQ(camera.origin, vec3(1, 2, 3));
    EXPECT_NEAR(camera.right.x, 2.0f, 1e-6f);
    EXPECT_NEAR(camera.up.z, 1.0f, 1e-6f);
    // A quarter of the larger side, which is 4 wide at a depth of 1.
    EXPECT_NEAR(camera.forward.x, 1.0f, 1e-6f);
    EXPECT_NEAR(camera.forward.y, 1.0f, 1e-6f);
    EXPECT_NEAR(camera.spread, 0.02f, 1e-6f);
    EXPECT_EQ(camera.orthographic, 0u);
}

TEST_F(CameraTrackTest, OneCameraMayHoldForAllFrames) {
    const CameraTrack track = read(frame(R"(, "fov_y": null, "orthographic_height": 4)", "all"));
    ASSERT_TRUE(track.at(123));
    const CameraParams camera = track.at(123)->params(200, 100);
    EXPECT_EQ(camera.orthographic, 1u);
    EXPECT_NEAR(camera.right.x, 4.0f, 1e-6f);
    EXPECT_NEAR(camera.up.z, 2.0f, 1e-6f);
}

/// 100x100 pixels that are twice as wide as high are a picture of 2 : 1.
TEST_F(CameraTrackTest, PixelsMayBeWide) {
    const CameraTrack track = read(frame(R"(, "fov_y": 90, "shift": [0.25, 0])", "7"));
    const CameraParams square = track.at(7)->params(200, 100), wide = track.at(7)->params(100, 100, 2.0f);
    EXPECT_EQ(wide.right, square.right);
    EXPECT_EQ(wide.up, square.up);
    EXPECT_EQ(wide.forward, square.forward);
    EXPECT_EQ(wide.spread, square.spread);
}

TEST_F(CameraTrackTest, FaultsAreNamed) {
    EXPECT_THAT(messageOf("{"), HasSubstr("is no JSON file"));
    EXPECT_THAT(messageOf("[]"), HasSubstr("has no object 'frames'"));
    EXPECT_THAT(messageOf(frame("")), HasSubstr("the camera of frame 1 needs 'fov_y', an angle between"));
    EXPECT_THAT(messageOf(frame(R"(, "fov_y": 180)")), HasSubstr("needs 'fov_y'"));
    EXPECT_THAT(messageOf(frame(R"(, "fov_y": "wide")")),
                HasSubstr("has a 'fov_y' that is no number or is too large"));
    EXPECT_THAT(messageOf(frame(R"(, "fov_y": 1e300)")),
                HasSubstr("has a 'fov_y' that is no number or is too large"));
    EXPECT_THAT(messageOf(frame(R"(, "fov": 40)")), HasSubstr("has the unknown member 'fov'"));
    EXPECT_THAT(messageOf(frame(R"(, "orthographic_height": -1)")), HasSubstr("not above 0"));
    EXPECT_THAT(messageOf(frame(R"(, "fov_y": 40, "shift": [1])")),
                HasSubstr("needs 'shift', a list of 2 numbers"));
    EXPECT_THAT(messageOf(frame(R"(, "fov_y": 40, "shift": [1, 1e300])")),
                HasSubstr("needs 'shift', a list of 2 numbers"));
    EXPECT_THAT(messageOf(frame(R"(, "fov_y": 40)", "one")), HasSubstr("'one' is no frame number"));
    EXPECT_THAT(messageOf(R"({"frames": {"1": 5}})"), HasSubstr("the camera of frame 1 is no object"));
    EXPECT_THAT(
        messageOf(R"({"frames": {"1": {"eye": [0,0,0], "forward": [0,0,1], "up": [0,0,2], "fov_y": 40}}})"),
        HasSubstr("looks along its 'up'"));
}

}  // namespace
}  // namespace limpid::shot
