#include "base/files/frame_pattern.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <climits>
#include <fstream>

#include "base/error.h"

namespace limpid {
namespace fs = std::filesystem;
namespace {

TEST(FramePattern, FormatsAsPrintfDoes) {
    EXPECT_EQ(FramePattern("a/b.%04d.exr").format(7), "a/b.0007.exr");
    EXPECT_EQ(FramePattern("b%04d").format(12345), "b12345") << "wider numbers are not cut";
    EXPECT_EQ(FramePattern("%d.png").format(0), "0.png");
    EXPECT_EQ(FramePattern("%09d").format(INT_MAX), "2147483647");
    EXPECT_EQ(FramePattern("50%%_%02d%%.exr").format(3), "50%_03%.exr");
    EXPECT_THROW(FramePattern("%d").format(-1), Error);
}

TEST(FramePattern, ANameWithoutANumberIsOneFile) {
    const FramePattern plain("a/still.exr");
    EXPECT_FALSE(plain.numbered());
    EXPECT_EQ(plain.format(5), "a/still.exr");
    EXPECT_EQ(plain.frameOf("still.exr"), std::nullopt);
    EXPECT_TRUE(plain.existingFrames().empty());
    const FramePattern percent("100%%04d.exr");
    EXPECT_FALSE(percent.numbered()) << "%% is a percent sign, whatever follows";
    EXPECT_EQ(percent.format(1), "100%04d.exr");
    EXPECT_TRUE(FramePattern("a.%04d.exr").numbered());
}

TEST(FramePattern, RefusesEveryOtherUseOfThePercentSign) {
    for (const char* text : {"50%.exr", "%",    "a%",    "a%04", "%4d",      "%s",  "%i",         "%x",
                             "%0d",     "%00d", "%012d", "%-4d", "%+d",      "% d", "%04u",       "%ld",
                             "%1$d",    "%.4d", "%04D",  "%d%d", "a%04d.%d", "%%%", "f%04d/a.exr"}) {
        try {
            FramePattern refused(text);
            ADD_FAILURE() << text << " was taken";
        } catch (const UsageError& error) {
            EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
        }
    }
}

TEST(FramePattern, KnowsItsOwnNamesOnly) {
    const FramePattern padded("folder/a.%04d.exr");
    EXPECT_EQ(padded.frameOf("a.0007.exr"), 7);
    EXPECT_EQ(padded.frameOf("a.12345.exr"), 12345);
    for (const char* name :
         {"a.7.exr", "a.00007.exr", "a..exr", "a.-001.exr", "a.0x07.exr", "b.0007.exr", "a.0007.png",
          "a.0007.exr~", "a.99999999999.exr", "a.exr", "", "folder/a.0007.exr"}) {
        EXPECT_EQ(padded.frameOf(name), std::nullopt) << name;
    }
    const FramePattern plain("%d");
    EXPECT_EQ(plain.frameOf("12"), 12);
    EXPECT_EQ(plain.frameOf("012"), std::nullopt);
    EXPECT_EQ(plain.frameOf("0"), 0);
    EXPECT_EQ(FramePattern("1%d1").frameOf("11"), std::nullopt)
        << "what stands around the number does not overlap";
    EXPECT_EQ(FramePattern("1%d1").frameOf("101"), 0);
}

TEST(FramePattern, ListsTheFramesThatExist) {
    const fs::path folder =
        fs::temp_directory_path() / ("limpid_frame_pattern_test." + std::to_string(::getpid()));
    fs::create_directories(folder / "a.0003.exr");  // a folder is not a frame
    for (const char* name :
         {"a.0010.exr", "a.0002.exr", "a.0001.exr", "a.5.exr", "b.0004.exr", "a.10000.exr"}) {
        std::ofstream(folder / name) << "x";
    }
    EXPECT_EQ(FramePattern((folder / "a.%04d.exr").string()).existingFrames(),
              (std::vector<int>{1, 2, 10, 10000}));
    EXPECT_TRUE(FramePattern((folder / "c.%04d.exr").string()).existingFrames().empty());
    EXPECT_THROW(FramePattern((folder / "none/a.%04d.exr").string()).existingFrames(), InputError);
    fs::remove_all(folder);
}

TEST(FramePattern, DescribesFramesInRuns) {
    EXPECT_EQ(describeFrames({}), "");
    EXPECT_EQ(describeFrames({4}), "4");
    EXPECT_EQ(describeFrames({1, 2, 3, 7, 9, 10}), "1-3, 7, 9-10");
}

}  // namespace
}  // namespace limpid
