#include "base/text/nearest_name.h"

#include <gtest/gtest.h>

#include <array>

namespace limpid {
namespace {

TEST(NearestName, DistancesAreTheFewestEdits) {
    EXPECT_EQ(editDistance("", ""), 0u);
    EXPECT_EQ(editDistance("width", "width"), 0u);
    EXPECT_EQ(editDistance("width", "widht"), 1u);   // swapped
    EXPECT_EQ(editDistance("width", "wdth"), 1u);    // deleted
    EXPECT_EQ(editDistance("width", "widdth"), 1u);  // inserted
    EXPECT_EQ(editDistance("width", "wixth"), 1u);   // replaced
    EXPECT_EQ(editDistance("kitten", "sitting"), 3u);
    EXPECT_EQ(editDistance("", "abc"), 3u);
    EXPECT_EQ(editDistance("ca", "abc"), 3u);  // no letter is edited twice
}

TEST(NearestName, ASimilarNameIsFoundAndAnotherIsNot) {
    const std::array<std::string, 4> names{"svgf", "atrous", "temporal", "bilateral"};
    EXPECT_EQ(nearestName("svfg", names), "svgf");
    EXPECT_EQ(nearestName("SVGF2", names), "svgf");
    EXPECT_EQ(nearestName("atorus", names), "atrous");
    EXPECT_EQ(nearestName("temp", names), "temporal");
    EXPECT_EQ(nearestName("te", names), "");
    EXPECT_EQ(nearestName("oidn", names), "");
    EXPECT_EQ(nearestName("", names), "");
    EXPECT_EQ(didYouMean("svfg", names), "; did you mean 'svgf'?");
    EXPECT_EQ(didYouMean("oidn", names), "");
}

}  // namespace
}  // namespace limpid
