// Tests the slider of every parameter that has one in the window.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/method/parameters.h"

namespace limpid {
namespace {

double numberOf(const ParamValue& value) {
    return std::visit([](auto v) { return static_cast<double>(v); }, value);
}

template <typename Function>
void forEachSlider(const Function& function) {
    for (const ParamGroup& group : paramGroups()) {
        for (const ParamInfo& info : group.infos) {
            if (std::holds_alternative<bool>(info.defaultValue)) continue;
            SCOPED_TRACE(group.name + "." + info.name);
            function(info);
        }
    }
}

TEST(Sliders, RunInsideTheRangeAndHoldTheDefault) {
    forEachSlider([](const ParamInfo& info) {
        const SliderSpan& span = info.slider;
        EXPECT_LT(span.min, span.max);
        EXPECT_GE(span.min, info.minimum);
        EXPECT_LE(span.max, info.maximum);
        // A float default is the rounding of a decimal number, so allow a small difference.
        const double initial = numberOf(info.defaultValue);
        EXPECT_GE(initial, span.min * (1.0 - 1e-6));
        EXPECT_LE(initial, span.max * (1.0 + 1e-6));
    });
}

/// Unless the default is one end of the slider, it is far from both ends, so that the user can move it either
/// way.
TEST(Sliders, LeaveRoomOnBothSidesOfTheDefault) {
    forEachSlider([](const ParamInfo& info) {
        const double initial = numberOf(info.defaultValue), at = sliderPosition(info.slider, initial);
        if (initial == info.minimum || initial == info.maximum) return;
        EXPECT_GE(at, 0.05);
        EXPECT_LE(at, 0.95);
    });
}

TEST(Sliders, OverManyDecadesAreLogarithmic) {
    forEachSlider([](const ParamInfo& info) {
        const SliderSpan& span = info.slider;
        const bool logarithmic = span.scale == SliderScale::Logarithmic;
        const double initial = numberOf(info.defaultValue);
        if (span.min > 0.0 && span.max > 100.0 * span.min) {
            EXPECT_TRUE(logarithmic);
        }
        if (initial > 0.0 && span.max > 100.0 * initial) {
            EXPECT_TRUE(logarithmic);
        }
        if (logarithmic) {
            EXPECT_GT(span.min > 0.0 ? span.min : span.smallest, 0.0);
        }
        EXPECT_LE(span.max, 1e5 * std::max(span.min > 0.0 ? span.min : span.smallest, 1e-3))
            << "more than five decades are no slider";
    });
}

/// Every tenth of the slider's length gives another value.
TEST(Sliders, ChangeTheValueWhereverTheyAreMoved) {
    forEachSlider([](const ParamInfo& info) {
        double before = sliderValue(info.slider, 0.0);
        for (int tenth = 1; tenth <= 10; ++tenth) {
            double value = sliderValue(info.slider, 0.1 * tenth);
            if (std::holds_alternative<int>(info.defaultValue) && info.slider.max - info.slider.min >= 10.0)
                value = std::round(value);
            EXPECT_GT(value, before - 1e-12);
            if (!std::holds_alternative<int>(info.defaultValue)) {
                EXPECT_GT(value, before);
            }
            before = value;
        }
    });
}

}  // namespace
}  // namespace limpid
