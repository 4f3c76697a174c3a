// Tests when the shutter is open, and that its instants are even and differ from frame to frame.
#include "renderer/sequence/shutter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "base/error.h"

namespace limpid {
namespace {

TEST(ShutterTest, OpensAndClosesWhereItsPositionSays) {
    using enum Shutter::Position;
    EXPECT_DOUBLE_EQ((Shutter{0.5, Start}.offset(0.0)), 0.0);
    EXPECT_DOUBLE_EQ((Shutter{0.5, Start}.offset(1.0)), 0.5);
    EXPECT_DOUBLE_EQ((Shutter{0.5, Center}.offset(0.0)), -0.25);
    EXPECT_DOUBLE_EQ((Shutter{0.5, Center}.offset(0.5)), 0.0);
    EXPECT_DOUBLE_EQ((Shutter{2.0, End}.offset(0.0)), -2.0);
    EXPECT_DOUBLE_EQ((Shutter{2.0, End}.offset(1.0)), 0.0);
    EXPECT_FALSE(Shutter{}.isOpen());
    EXPECT_EQ(toString(Shutter{}), "closed");
    for (const char* name : {"start", "center", "end"})
        EXPECT_EQ(toString(Shutter{0.25, parseShutterPosition(name)}), std::string("0.25 frames, ") + name);
    EXPECT_THROW(parseShutterPosition("middle"), UsageError);
}

/// The gaps between n successive points of the golden ratio's sequence are less than its square, 2.618, times
/// as wide as 1 / n.
TEST(ShutterTest, InstantsAreEvenForAnyNumberOfLaunches) {
    for (const uint64_t first : {uint64_t{0}, uint64_t{1000}, uint64_t{1} << 24}) {
        for (const size_t count : {1u, 2u, 3u, 5u, 16u, 64u, 1000u}) {
            std::vector<double> instants;
            for (size_t i = 0; i < count; ++i) instants.push_back(shutterInstant(3, 7, first + i));
            std::ranges::sort(instants);
            ASSERT_GE(instants.front(), 0.0);
            ASSERT_LT(instants.back(), 1.0);
            double gap = 1.0 - instants.back() + instants.front();
            for (size_t i = 1; i < count; ++i) gap = std::max(gap, instants[i] - instants[i - 1]);
            EXPECT_LT(gap, 2.6181 / static_cast<double>(count)) << count << " from " << first;
        }
    }
}

/// Chi-square of a launch's instants over many frames and seeds: each instant is as probable as any other.
TEST(ShutterTest, EachLaunchIsUniformOverFramesAndSeeds) {
    constexpr size_t bins = 16, frames = 1600;
    for (const uint32_t seed : {0u, 1u, 12345u}) {
        for (const uint64_t launch : {0u, 1u, 63u}) {
            std::vector<double> count(bins);
            for (uint64_t frame = 0; frame < frames; ++frame)
                count[static_cast<size_t>(shutterInstant(seed, frame, launch) * bins)] += 1.0;
            double chiSquare = 0.0;
            const double wanted = static_cast<double>(frames) / bins;
            for (const double c : count) chiSquare += (c - wanted) * (c - wanted) / wanted;
            EXPECT_LT(chiSquare, 37.7) << "of 15 degrees of freedom, p = 0.001; seed " << seed;
        }
    }
    std::set<double> offsets;
    for (uint32_t seed = 0; seed < 100; ++seed) offsets.insert(shutterInstant(seed, 0, 0));
    EXPECT_EQ(offsets.size(), 100u) << "renders with other seeds can be averaged";
}

}  // namespace
}  // namespace limpid
