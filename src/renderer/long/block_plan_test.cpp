#include "renderer/long/block_plan.h"

#include <gtest/gtest.h>

#include "renderer/long/sums/accumulation_header.h"

namespace limpid {
namespace {

TEST(BlockPlan, BlocksAndLaunchesCoverEverySampleOnce) {
    for (const uint64_t samples : {1u, 7u, 63u, 64u, 65u, 200u, 1000u}) {
        for (const uint32_t blockSamples : {1u, 5u, 64u}) {
            for (const uint32_t launchSamples : {1u, 3u, 4u}) {
                const BlockPlan plan{samples, blockSamples, std::min(launchSamples, blockSamples)};
                uint64_t sum = 0, launches = 0;
                for (uint32_t block = 0; block < plan.blocks(); ++block) {
                    EXPECT_EQ(plan.firstLaunch(block), launches) << samples << " " << block;
                    EXPECT_GE(plan.samplesOf(block), 1u);
                    EXPECT_LE(plan.samplesOf(block), blockSamples);
                    EXPECT_GE(plan.launchesOf(block) * plan.launchSamples, plan.samplesOf(block));
                    EXPECT_LT((plan.launchesOf(block) - 1) * plan.launchSamples, plan.samplesOf(block));
                    sum += plan.samplesOf(block);
                    launches += plan.launchesOf(block);
                }
                EXPECT_EQ(sum, samples);
                EXPECT_EQ(plan.launches(), launches);
            }
        }
    }
}

TEST(BlockPlan, TheLargestRenderFits) {
    const BlockPlan plan{maxSamplesPerPixel, 1, 1};
    EXPECT_EQ(plan.blocks(), maxSamplesPerPixel);
    EXPECT_EQ(plan.launches(), maxSamplesPerPixel);
}

TEST(Shard, EveryNumberIsInExactlyOne) {
    for (const uint32_t count : {1u, 2u, 3u, 7u}) {
        for (uint64_t total = 0; total < 16; ++total) {
            uint64_t sum = 0;
            std::vector<int> owners(total);
            for (uint32_t index = 1; index <= count; ++index) {
                const Shard shard{index, count};
                for (uint64_t k = 0; k < shard.countOf(total); ++k) {
                    ASSERT_LT(shard.at(k), total);
                    EXPECT_TRUE(shard.has(shard.at(k)));
                    ++owners[shard.at(k)];
                }
                sum += shard.countOf(total);
            }
            EXPECT_EQ(sum, total) << count;
            for (const int owner : owners) EXPECT_EQ(owner, 1);
        }
    }
}

}  // namespace
}  // namespace limpid
