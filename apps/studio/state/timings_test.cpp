#include "studio/state/timings.h"

#include <gtest/gtest.h>

namespace limpid::studio {
namespace {

TEST(Timings, PassesOfOneNameAddUpInTheFramesOrder) {
    Timings timings;
    timings.addPasses({{"b", 1.0}, {"a", 2.0}, {"b", 3.0}});
    timings.addPasses({{"b", 5.0}, {"a", 7.0}});
    ASSERT_EQ(timings.passes().size(), 2u);
    EXPECT_EQ(timings.passes()[0].name, "b");
    EXPECT_EQ(timings.passes()[0].milliseconds.values(), (std::vector<float>{4.0f, 5.0f}));
    EXPECT_EQ(timings.passes()[1].milliseconds.last(), 7.0f);
    timings.addPasses({{"a", 1.0}});
    ASSERT_EQ(timings.passes().size(), 1u);
    EXPECT_EQ(timings.passes()[0].milliseconds.values(), (std::vector<float>{2.0f, 7.0f, 1.0f}));
}

TEST(Timings, DurationsAreShort) {
    EXPECT_EQ(durationText(0.01234f), "0.0123 ms");
    EXPECT_EQ(durationText(16.66f), "16.7 ms");
    EXPECT_EQ(durationText(999.4f), "999 ms");
    EXPECT_EQ(durationText(999.6f), "1.0 s");
    EXPECT_EQ(durationText(32467.7f), "32.5 s");
}

TEST(Timings, TheOldestAreForgotten) {
    Track track;
    for (int i = 0; i < 500; ++i) track.add(static_cast<float>(i));
    EXPECT_EQ(track.values().size(), Track::maxValues);
    EXPECT_EQ(track.values().front(), 500.0f - static_cast<float>(Track::maxValues));
    EXPECT_EQ(track.last(), 499.0f);
}

}  // namespace
}  // namespace limpid::studio
