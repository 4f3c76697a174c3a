#include "base/slider_span.h"

#include <gtest/gtest.h>

namespace limpid {
namespace {

TEST(SliderSpan, SmallRangesAreLinearAndWhole) {
    const SliderSpan share = usefulSpan(0.0, 1.0, 0.3, false);
    EXPECT_EQ(share.scale, SliderScale::Linear);
    EXPECT_EQ(share.min, 0.0);
    EXPECT_EQ(share.max, 1.0);
    EXPECT_EQ(usefulSpan(-1.0, 1.0, 0.5, false).min, -1.0);
    EXPECT_EQ(usefulSpan(0.0, 10.0, 5.0, true).max, 10.0);
}

TEST(SliderSpan, WideRangesAreLogarithmicAroundTheDefault) {
    const SliderSpan factor = usefulSpan(1e-9, 1e9, 3e-4, false);
    EXPECT_EQ(factor.scale, SliderScale::Logarithmic);
    EXPECT_DOUBLE_EQ(factor.min, 3e-6);
    EXPECT_DOUBLE_EQ(factor.max, 3e-2);
    EXPECT_NEAR(sliderPosition(factor, 3e-4), 0.5, 1e-9);
    const SliderSpan fromZero = usefulSpan(0.0, 1000.0, 0.2, false);
    EXPECT_EQ(fromZero.scale, SliderScale::Logarithmic);
    EXPECT_EQ(fromZero.min, 0.0);
    EXPECT_NEAR(sliderPosition(fromZero, 0.2), 0.5, 0.02);
    EXPECT_LE(usefulSpan(0.0, 1024.0, 8.0, true).max, 64.0);
}

TEST(SliderSpan, PositionsAndValuesAreReverses) {
    for (const SliderSpan& span : {SliderSpan{-1.0, 3.0}, SliderSpan{0.01, 100.0, SliderScale::Logarithmic},
                                   SliderSpan{0.0, 10.0, SliderScale::Logarithmic, 0.01}}) {
        for (const double position : {0.0, 0.1, 0.37, 0.5, 0.99, 1.0})
            EXPECT_NEAR(sliderPosition(span, sliderValue(span, position)), position, 0.002);
        EXPECT_EQ(sliderValue(span, 0.0), span.min);
        EXPECT_EQ(sliderValue(span, 1.0), span.max);
        EXPECT_EQ(sliderPosition(span, span.min - 1.0), 0.0) << "outside: the left end";
        EXPECT_EQ(sliderPosition(span, span.max + 1.0), 1.0) << "outside: the right end";
    }
}

TEST(SliderSpan, ValuesAreRound) {
    const SliderSpan span{0.001, 10.0, SliderScale::Logarithmic};
    EXPECT_DOUBLE_EQ(sliderValue(span, 0.5), 0.1);
    const double value = sliderValue(span, 0.3);
    EXPECT_DOUBLE_EQ(value * 1e5, static_cast<double>(static_cast<int>(value * 1e5 + 0.5)));
}

}  // namespace
}  // namespace limpid
