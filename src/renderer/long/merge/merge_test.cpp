#include "renderer/long/merge/merge.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/error.h"
#include "renderer/long/sums/accumulation_fixture.h"

namespace limpid::test {
namespace {

namespace fs = std::filesystem;

class MergeTest : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / fmt::format("limpid_merge_test.{}", ::getpid());
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path put(const char* name, const AccumulationHeader& header, const std::vector<uint32_t>& blocks) {
        writeAccumulation(folder_ / name, header, randomSums(header, blocks));
        return folder_ / name;
    }
    static AccumulationHeader headerOf(uint32_t shard, uint32_t shards) {
        AccumulationHeader header = smallHeader();
        header.layers = allLayers;
        header.shard = {shard, shards};
        return header;
    }
    static std::string faultOf(const std::vector<fs::path>& files) {
        try {
            mergeAccumulations(files);
        } catch (const InputError& error) {
            return error.what();
        }
        return "none";
    }

    fs::path folder_;
};

TEST_F(MergeTest, GivesWhatOneRunGives) {
    const fs::path one = put("1", headerOf(1, 4), {0}), two = put("2", headerOf(2, 4), {1}),
                   three = put("3", headerOf(3, 4), {2}), four = put("4", headerOf(4, 4), {});
    const FrameSums whole = randomSums(headerOf(1, 1), {0, 1, 2});
    expectSame(mergeAccumulations(std::vector{one, two, three, four}).sums, whole);
    expectSame(mergeAccumulations(std::vector{four, three, one, two}).sums, whole);
    expectSame(mergeAccumulations(std::vector{put("all", headerOf(1, 1), {2, 1, 0})}).sums, whole);
}

TEST_F(MergeTest, WhatIsMissingIsNamed) {
    const fs::path one = put("1", headerOf(1, 2), {0, 2}), two = put("2", headerOf(2, 2), {});
    EXPECT_THAT(faultOf({one}),
                testing::AllOf(testing::HasSubstr("lacks block 1"), testing::HasSubstr("shard 2 of 2")));
    EXPECT_THAT(faultOf({one, two}), testing::HasSubstr("lacks block 1"));
    EXPECT_THAT(faultOf({two}), testing::HasSubstr("0-2"));
}

TEST_F(MergeTest, WhatDoesNotBelongIsNamed) {
    const fs::path one = put("1", headerOf(1, 2), {0, 2});
    AccumulationHeader other = headerOf(2, 2);
    other.identity[1].second = "5";
    EXPECT_THAT(faultOf({one, put("2", other, {1})}),
                testing::AllOf(testing::StartsWith((folder_ / "2").string() + ": "),
                               testing::HasSubstr("seed is 5, not 0")));
    other = headerOf(2, 2);
    other.floatColors = true;
    EXPECT_THAT(faultOf({one, put("2", other, {1})}), testing::HasSubstr("--float"));
    other = headerOf(2, 2);
    other.toneCurve = "agx";
    EXPECT_THAT(faultOf({one, put("2", other, {1})}),
                testing::HasSubstr("--tone-curve is agx, not standard"));
    other = headerOf(2, 2);
    other.layers = {};
    EXPECT_THAT(faultOf({one, put("2", other, {1})}), testing::HasSubstr("layers"));
    EXPECT_THAT(faultOf({one, one}), testing::HasSubstr("block 0, which is in an earlier file"));
    EXPECT_THAT(faultOf({one, put("3", headerOf(2, 3), {1}), put("4", headerOf(3, 3), {2})}),
                testing::HasSubstr("block 2, which is in an earlier file"));
    AccumulationHeader sequence = headerOf(1, 1);
    sequence.frames = 3;
    EXPECT_THAT(faultOf({put("5", sequence, {0, 1, 2})}), testing::HasSubstr("sequence"));
    EXPECT_THROW(mergeAccumulations({}), UsageError);
}

}  // namespace
}  // namespace limpid::test
