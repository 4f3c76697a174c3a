#include "studio/camera/camera_rig.h"

#include <gmock/gmock.h>

namespace limpid::studio {
namespace {

TEST(CameraNames, TellApartWhatAFileDoesNot) {
    std::vector<scene::Camera> cameras(4);
    cameras[0].name = "door";
    cameras[2].name = "window";
    cameras[3].name = "door";
    EXPECT_THAT(cameraNames(cameras), testing::ElementsAre("door (0)", "camera 1", "window", "door (3)"));
}

}  // namespace
}  // namespace limpid::studio
