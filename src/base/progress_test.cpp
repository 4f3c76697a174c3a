#include "base/progress.h"

#include <gtest/gtest.h>

namespace limpid {
namespace {

TEST(Progress, PartsReportSharesOfTheWhole) {
    const Progress whole = Progress::watched();
    EXPECT_EQ(whole.done(), 0.0);
    const Progress half = whole.part(0.5, 1.0);
    half.at(0.0);
    EXPECT_EQ(whole.done(), 0.5);
    half.part(0.25, 0.75).at(1, 2);
    EXPECT_EQ(whole.done(), 0.75);
    half.at(1.0);
    EXPECT_EQ(whole.done(), 1.0);
    half.at(0.5);
    EXPECT_EQ(whole.done(), 1.0);  // what another part reports late takes nothing back
}

TEST(Progress, EndsWorkThatWasGivenUp) {
    const Progress whole = Progress::watched();
    const Progress part = whole.part(0.0, 0.5);
    part.at(0.5);
    whole.cancel();
    EXPECT_THROW(part.at(0.75), Cancelled);
    EXPECT_EQ(whole.done(), 0.25);
}

TEST(Progress, OfWorkThatNobodyWatchesDoesNothing) {
    const Progress none;
    none.cancel();
    EXPECT_NO_THROW(none.part(0.0, 0.5).at(3, 0));
    EXPECT_EQ(none.done(), 0.0);
}

}  // namespace
}  // namespace limpid
