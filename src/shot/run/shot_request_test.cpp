#include "shot/run/shot_request.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.h"
#include "image/io/temp_folder.h"

namespace limpid::shot {
namespace {

/// Twelve numbered files, which jobOf() does not read.
class ShotRequestTest : public testing::Test {
  protected:
    ShotRequestTest() {
        for (int frame = 1; frame <= 12; ++frame)
            image::test::put(folder_ / ("a." + std::to_string(frame) + ".exr"), "");
        request_.input = path("a.%d.exr");
    }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string faultOf(const std::string& output) {
        request_.output = path(output);
        try {
            jobOf(request_);
        } catch (const UsageError& error) {
            return error.what();
        }
        return "none";
    }

    image::test::TempFolder folder_;
    ShotRequest request_;
};

TEST_F(ShotRequestTest, NoOutputMayBeAnInput) {
    EXPECT_EQ(faultOf("b.%d.exr"), "none");
    EXPECT_NE(faultOf("a.%d.exr").find("the output is the input"), std::string::npos);
    EXPECT_NE(faultOf("./a.%d.exr").find("the output is the input"), std::string::npos);
    // The names are equal from a frame on that is not the first.
    EXPECT_EQ(faultOf("a.%03d.exr"), "none");
    EXPECT_NE(faultOf("a.%02d.exr").find("the output is the input"), std::string::npos);
    // Frame 2 would replace frame 12.
    EXPECT_NE(faultOf("a.1%d.exr").find("the output is the input"), std::string::npos);
    std::filesystem::create_symlink("a.7.exr", folder_ / "b.7.exr");
    EXPECT_NE(faultOf("b.%d.exr").find("the output is the input"), std::string::npos);
}

TEST_F(ShotRequestTest, NoOutputMayBeAFrameThatIsLeftOut) {
    request_.frames = "1-2";
    EXPECT_EQ(faultOf("b.%d.exr"), "none");
    // Frame 2 would replace frame 12.
    EXPECT_NE(faultOf("a.1%d.exr").find("the output is the input"), std::string::npos);
    EXPECT_EQ(faultOf("a.9%d.exr"), "none");
    std::filesystem::create_symlink("a.7.exr", folder_ / "b.2.exr");
    EXPECT_NE(faultOf("b.%d.exr").find("the output is the input"), std::string::npos);
    // This output is not written.
    std::filesystem::create_symlink("a.7.exr", folder_ / "c.7.exr");
    EXPECT_EQ(faultOf("c.%d.exr"), "none");
    image::test::put(folder_ / "albedo.11.exr", "");
    request_.files = {"albedo=" + path("albedo.%d.exr"), "normal=" + path("none/normal.%d.exr")};
    EXPECT_EQ(faultOf("b.%03d.exr"), "none");
    EXPECT_NE(faultOf("albedo.1%d.exr").find("the output is the file of --file albedo"), std::string::npos);
}

TEST_F(ShotRequestTest, LinksToNoFileAreNoOutputs) {
    std::filesystem::remove(folder_ / "a.3.exr");
    std::filesystem::create_symlink("a.3.exr", folder_ / "a.3.exr");
    std::filesystem::create_symlink("normal.exr", folder_ / "normal.exr");
    request_.files = {"normal=" + path("normal.exr")};
    EXPECT_EQ(faultOf("b.%d.exr"), "none");
    EXPECT_NE(faultOf("a.1%d.exr").find("the output is the input"), std::string::npos);
}

TEST_F(ShotRequestTest, NoOutputMayBeAnAttachedFile) {
    request_.files = {"albedo=" + path("albedo.%d.pfm"), "normal=" + path("normal.exr")};
    EXPECT_EQ(faultOf("b.%d.exr"), "none");
    std::filesystem::create_symlink("b.3.exr", folder_ / "albedo.3.pfm");
    EXPECT_NE(faultOf("b.%d.exr").find("the output is the file of --file albedo"), std::string::npos);
    std::filesystem::create_symlink("c.12.exr", folder_ / "normal.exr");
    EXPECT_NE(faultOf("c.%d.exr").find("the output is the file of --file normal"), std::string::npos);
}

}  // namespace
}  // namespace limpid::shot
