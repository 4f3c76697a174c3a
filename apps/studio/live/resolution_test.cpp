#include "studio/live/resolution.h"

#include <gtest/gtest.h>

namespace limpid::studio {
namespace {

constexpr gpu::Extent window{1280, 720};
constexpr uint64_t allPixels = 1280 * 720;

TEST(ResolutionControl, FixedChoicesDivideTheSides) {
    ResolutionControl control(true);
    control.note(allPixels, 100.0);
    EXPECT_EQ(control.choose(window, Resolution::Full, true), window);
    EXPECT_EQ(control.choose(window, Resolution::Half, true), (gpu::Extent{640, 360}));
    EXPECT_EQ(control.choose(window, Resolution::Eighth, false), (gpu::Extent{160, 90}));
    EXPECT_EQ(control.choose({3, 1}, Resolution::Eighth, false), (gpu::Extent{1, 1}));
    EXPECT_FALSE(control.isCoarse());
}

TEST(ResolutionControl, OnlyMeasuredTimeMakesItCoarse) {
    ResolutionControl fast(false), slow(false);
    fast.note(allPixels, 0.01);
    slow.note(allPixels, 1.0);
    EXPECT_EQ(fast.choose({8000, 4000}, Resolution::Automatic, false), (gpu::Extent{8000, 4000}));
    EXPECT_EQ(fast.choose(window, Resolution::Automatic, true), window);
    const gpu::Extent coarse = slow.choose(window, Resolution::Automatic, true);
    EXPECT_TRUE(slow.isCoarse());
    // The expected time of the coarse frame keeps the limit.
    EXPECT_LE(double{1.0} * coarse.width * coarse.height / double{allPixels},
              1.1 * ResolutionControl::movingSeconds);
    EXPECT_GE(coarse.width, 1280u / 5);
}

TEST(ResolutionControl, AtRestItIsFull) {
    ResolutionControl control(true);
    control.note(allPixels, 5.0);
    EXPECT_NE(control.choose(window, Resolution::Automatic, true), window);
    EXPECT_EQ(control.choose(window, Resolution::Automatic, false), window);
    EXPECT_FALSE(control.isCoarse());
}

TEST(ResolutionControl, AnUnknownCpuBeginsCoarseAlsoAtRest) {
    ResolutionControl control(true), gpuControl(false);
    EXPECT_EQ(control.choose(window, Resolution::Automatic, false), (gpu::Extent{160, 90}));
    EXPECT_TRUE(control.isCoarse());
    EXPECT_EQ(gpuControl.choose(window, Resolution::Automatic, false), window);
    control.note(160 * 90, 0.001);
    EXPECT_EQ(control.choose(window, Resolution::Automatic, false), window);
    control.forget();
    EXPECT_NE(control.choose(window, Resolution::Automatic, false), window);
}

TEST(ResolutionControl, ShortFramesAreNotWorthGivingUp) {
    ResolutionControl control(true);
    EXPECT_TRUE(control.takesLong(allPixels)) << "nothing is known";
    control.note(allPixels, 1.0);
    EXPECT_TRUE(control.takesLong(allPixels));
    EXPECT_FALSE(control.takesLong(allPixels / 64));
}

/// Each other size starts histories anew, so small changes of the time do not change it.
TEST(ResolutionControl, AMovementKeepsItsSize) {
    ResolutionControl control(false);
    control.note(allPixels, 1.0);
    const gpu::Extent first = control.choose(window, Resolution::Automatic, true);
    const uint64_t pixels = uint64_t{first.width} * first.height;
    for (const double factor : {1.5, 0.6, 1.3, 0.8}) {
        control.note(pixels, factor * ResolutionControl::movingSeconds);
        EXPECT_EQ(control.choose(window, Resolution::Automatic, true), first) << factor;
    }
    for (int i = 0; i < 4; ++i) control.note(pixels, 4.0 * ResolutionControl::movingSeconds);
    EXPECT_LT(control.choose(window, Resolution::Automatic, true).width, first.width);
}

}  // namespace
}  // namespace limpid::studio
