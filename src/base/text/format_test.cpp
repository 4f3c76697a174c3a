#include "base/text/format.h"

#include <gtest/gtest.h>

namespace limpid {
namespace {

TEST(FormatTextTest, ReplacesPlaceholdersInTurn) {
    EXPECT_EQ(formatText("{} of {}: {}", 1, "two", std::string("three")), "1 of two: three");
    EXPECT_EQ(formatText("none"), "none");
    const char array[8] = "array";
    EXPECT_EQ(formatText("{} {}", array, static_cast<const char*>(array)), "array array");
    EXPECT_EQ(formatText("{} {}", "{}", 2), "{} 2");
    EXPECT_EQ(formatText("{} {}", -5, true), "-5 true");
    EXPECT_EQ(formatText("{}", UINT64_MAX), "18446744073709551615");
}

TEST(FormatTextTest, WritesNumbersWithAsFewDigitsAsNeeded) {
    EXPECT_EQ(formatText("{} {} {}", 0.1f, 1.0, 1e6), "0.1 1 1000000");
    EXPECT_EQ(formatText("{} {}", 1e-4, 1e-6), "0.0001 1e-06");
    EXPECT_EQ(formatText("{}", 1e20), "1e+20");
}

TEST(FormatTextTest, Joins) {
    EXPECT_EQ(joinText({}), "");
    EXPECT_EQ(joinText({"a", "b"}), "a, b");
}

TEST(FormatTextTest, CountsInThePlural) {
    EXPECT_EQ(countText(0, "sample"), "0 samples");
    EXPECT_EQ(countText(1, "sample"), "1 sample");
}

}  // namespace
}  // namespace limpid
