#include "studio/compare/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "base/error.h"
#include "renderer/method/parameters.h"
#include "studio/state/state_json.h"

namespace limpid::studio {
namespace {

TEST(Comparison, AReferenceIsTheIntegratorAloneWithOtherNumbers) {
    ComparisonChoice choice;
    choice.with = static_cast<int>(comparisonNames().size()) - 2;
    ASSERT_TRUE(choice.isReference());
    RenderSettings settings;
    settings.pipeline = parsePipeline("path", "svgf");
    settings.jitter = Jitter::Off;
    settings.seed = 7;
    RenderSettings other = comparisonSettings(choice, settings);
    EXPECT_EQ(other.pipeline, Pipeline{});
    EXPECT_EQ(other.jitter, Jitter::Off);
    EXPECT_EQ(other.seed, 8u);
    settings.jitter = Jitter::Frame;
    EXPECT_EQ(comparisonSettings(choice, settings).jitter, Jitter::Pixel);
    settings.pipeline = parsePipeline("ao", "svgf");
    EXPECT_EQ(comparisonSettings(choice, settings).pipeline, parsePipeline("ao"));
    settings.pipeline = parsePipeline("gbuffer");
    EXPECT_EQ(comparisonSettings(choice, settings).pipeline, Pipeline{});
}

TEST(Comparison, NothingNeedsNoOtherSettings) {
    RenderSettings settings;
    settings.pipeline = parsePipeline("path", "svgf");
    settings.seed = 7;
    EXPECT_EQ(comparisonSettings({}, settings), settings);
}

TEST(Comparison, EveryIntegratorAndDenoiserCanBeChosen) {
    const std::vector<std::string> names = comparisonNames();
    ASSERT_EQ(names.size(), 3 + integrators().size() + denoise::denoisers().size());
    RenderSettings settings;
    settings.pipeline = parsePipeline("ao", "atrous");
    for (size_t i = 1; i + 2 < names.size(); ++i) {
        const Pipeline chosen = comparisonSettings({.with = static_cast<int>(i)}, settings).pipeline;
        EXPECT_EQ(chosen,
                  denoise::findDenoiser(names[i]) ? parsePipeline("ao", names[i]) : parsePipeline(names[i]));
    }
    settings.pipeline = parsePipeline("path", "svgf");
    for (size_t i = 1; i < names.size(); ++i) {
        if (names[i] == "visibility") {
            EXPECT_EQ(comparisonSettings({.with = static_cast<int>(i)}, settings).pipeline,
                      parsePipeline("ao", "visibility"));
        }
    }
    settings.pipeline = parsePipeline("preview");
    const auto kpcn = std::ranges::find(names, "kpcn");
    EXPECT_EQ(comparisonSettings({.with = static_cast<int>(kpcn - names.begin())}, settings).pipeline,
              parsePipeline("path", "kpcn"));
}

/// Two settings of one denoiser on the same noise.
TEST(Comparison, KeptSettingsStayAsTheyWere) {
    RenderSettings settings;
    settings.pipeline = parsePipeline("path", "svgf");
    assign(settings, "svgf.levels=2");
    ComparisonChoice choice;
    choice.keep(settings);
    EXPECT_TRUE(choice.isKept());
    EXPECT_EQ(comparisonNames().at(static_cast<size_t>(choice.with)), "kept settings");
    assign(settings, "svgf.levels=5");
    settings.seed = 8;
    settings.extent = {33, 44};
    const RenderSettings other = comparisonSettings(choice, settings);
    EXPECT_EQ(other.pipeline, settings.pipeline);
    EXPECT_EQ(assignmentsOf(other), std::vector<std::string>{"svgf.levels=2"});
    EXPECT_EQ(other.seed, 8u);
    EXPECT_EQ(other.extent, settings.extent);
}

/// They also travel as JSON, with the jitter that was in force.
TEST(Comparison, KeptSettingsTravelWithTheirJitter) {
    State state, other;
    state.render.pipeline = parsePipeline("path", "svgf");
    for (const Jitter jitter : {Jitter::Pixel, Jitter::Frame, Jitter::Off}) {
        state.render.jitter = jitter;
        state.comparison.keep(state.render);
        apply(other, {{"kept_settings", toJson(state)["kept_settings"]}});
        EXPECT_EQ(other.comparison.kept.jitter, jitter);
        EXPECT_EQ(other.comparison.kept.pipeline, state.render.pipeline);
    }
    EXPECT_THROW(apply(other, {{"kept_settings", {"jitter=often"}}}), UsageError);
}

TEST(LiveScores, AreThoseOfTheDisplayedPictures) {
    // 0.25 and 0.36 of linear light, two stops darker: sRGB values 0.2771 and 0.3317.
    const image::Image test(16, 16, 3, 0.25f), reference(16, 16, 3, 0.36f);
    LiveScores scores;
    scores.compare(test, reference, -2.0f);
    while (!scores.finish()) std::this_thread::yield();
    EXPECT_EQ(scores.text().substr(0, 10), "PSNR 25.27");
    ASSERT_EQ(scores.errors().values().size(), 1u);
    EXPECT_NEAR(scores.errors().last(), std::stof(scores.text().substr(scores.text().find("FLIP") + 5)),
                1e-4f);
}

TEST(LiveScores, WhatIsNoLongerWantedIsDiscarded) {
    LiveScores scores;
    scores.compare(image::Image(16, 16, 3, 0.25f), image::Image(16, 16, 3, 0.36f), 0.0f);
    scores.clear();
    while (scores.busy()) EXPECT_FALSE(scores.finish());
    EXPECT_EQ(scores.text(), "");
}

}  // namespace
}  // namespace limpid::studio
