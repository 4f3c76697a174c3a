#include "viewer/compare/comparison.h"

#include <gtest/gtest.h>

#include <thread>

namespace limpid::viewer {
namespace {

TEST(Comparison, AReferenceIsThePathTracerWithOtherNumbers) {
    ComparisonChoice choice;
    choice.with = static_cast<int>(comparisonNames().size()) - 1;
    ASSERT_TRUE(choice.isReference());
    RenderSettings settings;
    settings.pipeline = parsePipeline("svgf");
    settings.jitter = Jitter::Off;
    settings.seed = 7;
    RenderSettings other = comparisonSettings(choice, settings);
    EXPECT_EQ(other.pipeline.name(), "path");
    EXPECT_EQ(other.jitter, Jitter::Off);
    EXPECT_EQ(other.seed, 8u);
    settings.jitter = Jitter::Frame;
    EXPECT_EQ(comparisonSettings(choice, settings).jitter, Jitter::Pixel);
}

TEST(Comparison, EveryPipelineCanBeChosen) {
    const std::vector<std::string> names = comparisonNames();
    for (size_t i = 1; i + 1 < names.size(); ++i)
        EXPECT_EQ(comparisonSettings({.with = static_cast<int>(i)}, {}).pipeline.name(), names[i]);
}

TEST(LiveScores, AreThoseOfTheDisplayedPictures) {
    // 0.25 and 0.36 of linear light at two stops less: sRGB code values 0.2771 and 0.3317.
    const image::Image test(16, 16, 3, 0.25f), reference(16, 16, 3, 0.36f);
    LiveScores scores;
    scores.compare(test, reference, -2.0f);
    while (!scores.finish()) std::this_thread::yield();
    EXPECT_EQ(scores.text().substr(0, 10), "PSNR 25.27");
}

TEST(LiveScores, WhatIsNoLongerWantedIsDiscarded) {
    LiveScores scores;
    scores.compare(image::Image(16, 16, 3, 0.25f), image::Image(16, 16, 3, 0.36f), 0.0f);
    scores.clear();
    while (scores.busy()) EXPECT_FALSE(scores.finish());
    EXPECT_EQ(scores.text(), "");
}

}  // namespace
}  // namespace limpid::viewer
