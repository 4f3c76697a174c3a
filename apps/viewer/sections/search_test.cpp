#include "viewer/sections/search.h"

#include <gtest/gtest.h>

namespace limpid::viewer {
namespace {

bool matches(const std::string& search, std::initializer_list<std::string_view> texts) {
    return viewer::matches(search, std::span(texts.begin(), texts.size()));
}

TEST(Search, FindsEveryWordInAnyText) {
    EXPECT_TRUE(matches("Levels", {"levels", "svgf.levels"}));
    EXPECT_TRUE(matches("svgf lev", {"levels", "svgf.levels"}));
    EXPECT_TRUE(matches("noise path", {"seed", "another seed gives other noise", "Pathtracer"}));
    EXPECT_FALSE(matches("noise glass", {"seed", "another seed gives other noise"}));
    EXPECT_TRUE(matches("firefly", {"fireflies"}));
    EXPECT_TRUE(matches("levels", {"level of detail"}));
    EXPECT_TRUE(matches("", {"seed"}));
    EXPECT_TRUE(matches("  seed ", {"seed"}));
}

}  // namespace
}  // namespace limpid::viewer
