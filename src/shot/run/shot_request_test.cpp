#include "shot/run/shot_request.h"

#include <fmt/format.h>
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

    /// "4 5 [6] 7": the frames of the job; those in brackets are written.
    std::string framesOf(const std::string& frames, const std::string& shard = {}) {
        request_.output = path("b.%d.exr");
        request_.frames = frames;
        request_.shard = shard;
        const ShotJob job = jobOf(request_);
        warnings_ = job.warnings;
        isSequence_ = job.load.sequence;
        std::string text;
        for (size_t i = 0; i < job.frames.size(); ++i)
            text += fmt::format("{}{}{}{}", i > 0 ? " " : "", i == job.firstWritten ? "[" : "", job.frames[i],
                                i + 1 == job.endWritten ? "]" : "");
        return text;
    }
    void remove(int frame) { std::filesystem::remove(folder_ / fmt::format("a.{}.exr", frame)); }

    image::test::TempFolder folder_;
    ShotRequest request_;
    std::vector<std::string> warnings_;
    bool isSequence_ = false;
};

TEST_F(ShotRequestTest, FramesAroundThoseThatAreAskedForMakeHistories) {
    EXPECT_EQ(framesOf(""), "[1 2 3 4 5 6 7 8 9 10 11 12]");
    EXPECT_EQ(framesOf("5-6"), "1 2 3 4 [5 6] 7 8 9 10 11 12");
    EXPECT_EQ(framesOf("7"), "1 2 3 4 5 6 [7] 8 9 10 11 12");
    EXPECT_TRUE(isSequence_);
    EXPECT_EQ(framesOf("3-10", "2/2"), "1 2 3 4 5 6 [7 8 9 10] 11 12") << "a part of these frames";
    remove(4);
    remove(9);
    EXPECT_EQ(framesOf("6-7"), "5 [6 7] 8") << "no history goes across a gap";
    EXPECT_THROW(framesOf("3-6"), InputError);
    EXPECT_THROW(framesOf("20-30"), InputError);
    remove(5);
    remove(7);
    EXPECT_EQ(framesOf("6"), "[6]");
    EXPECT_FALSE(isSequence_);
}

TEST_F(ShotRequestTest, RunUpsAreLimited) {
    for (int frame = 13; frame <= 60; ++frame) image::test::put(folder_ / fmt::format("a.{}.exr", frame), "");
    const std::string text = framesOf("30-31");
    EXPECT_TRUE(text.starts_with("14 15 ")) << text;
    EXPECT_TRUE(text.ends_with(" 46 47")) << text;
}

TEST_F(ShotRequestTest, RunUpsHaveCamerasIfTheFramesDo) {
    const std::string camera = R"({"eye": [0, 0, 1], "forward": [0, 0, -1], "up": [0, 1, 0], "fov_y": 40})";
    image::test::put(folder_ / "c.json",
                     fmt::format(R"({{"frames": {{"4": {0}, "5": {0}, "6": {0}}}}})", camera));
    request_.cameras = path("c.json");
    EXPECT_EQ(framesOf("5-6"), "4 [5 6]");
    EXPECT_TRUE(warnings_.empty());
    EXPECT_EQ(framesOf("6"), "4 5 [6]");
    EXPECT_EQ(framesOf("4"), "[4] 5 6");
    EXPECT_EQ(framesOf("6-8"), "4 5 [6 7 8]");
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_[0].find("has no camera for frames 7-8"), std::string::npos) << warnings_[0];
}

TEST_F(ShotRequestTest, MissingFramesAreNamed) {
    request_.onError = "skip";
    framesOf("");
    EXPECT_TRUE(warnings_.empty());
    for (const int frame : {3, 7, 8}) remove(frame);
    EXPECT_EQ(framesOf(""), "[1 2 4 5 6 9 10 11 12]");
    EXPECT_EQ(warnings_, std::vector{path("a.%d.exr") + ": frames 3, 7-8 are missing"});
    EXPECT_EQ(framesOf("4-7"), "[4 5 6]");
    EXPECT_EQ(warnings_, std::vector{path("a.%d.exr") + ": frame 7 is missing"});
    framesOf("0-2147483647");
    EXPECT_EQ(warnings_, std::vector{path("a.%d.exr") + ": frames 0, 3, 7-8, 13-2147483647 are missing"});
    for (int frame = 20; frame <= 100; frame += 2)
        image::test::put(folder_ / fmt::format("a.{}.exr", frame), "");
    framesOf("");
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_TRUE(warnings_[0].ends_with(", 53 and others (50 in all) are missing")) << warnings_[0];
    request_.onError = "stop";
    EXPECT_THROW(framesOf("1-4"), InputError);
}

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
