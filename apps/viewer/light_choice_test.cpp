#include "light_choice.h"

#include <gtest/gtest.h>

namespace limpid::viewer {
namespace {

TEST(LightChoice, SaysWhatTheCommandLineSays) {
    for (const char* lamp : {"", "point,1,2.5,-3,0.25"}) EXPECT_EQ(lightChoiceOf(lamp, "").lamp(), lamp);
    EXPECT_EQ(lightChoiceOf("", "0.5,1,0").backgroundText(), "0.5,1,0");
    EXPECT_EQ(lightChoiceOf("", "").backgroundText(), "");
}

TEST(LightChoice, ASunKeepsItsDirection) {
    const LightChoice sun = lightChoiceOf("sun,0,4,-3,2", "");
    EXPECT_EQ(sun.kind, 2);
    EXPECT_LT(glm::distance(sun.at, vec3(0.0f, 0.8f, -0.6f)), 1e-6f);
    EXPECT_EQ(sun.intensity, 2.0f);
}

}  // namespace
}  // namespace limpid::viewer
