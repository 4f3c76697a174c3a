#include "renderer/frame/presets.h"

#include <gmock/gmock.h>

#include <set>

#include "base/error.h"
#include "renderer/frame/parameters.h"

namespace limpid {
namespace {

using testing::Contains;
using testing::HasSubstr;

TEST(Presets, SayAllThatTheyNeedAndOnlyWhatThereIs) {
    std::set<std::string> names;
    for (const Preset& preset : presets()) {
        EXPECT_TRUE(names.insert(preset.name).second) << preset.name;
        EXPECT_GT(preset.help.size(), 20u);
        ASSERT_FALSE(preset.pipelines.empty());
        for (const std::string& pipeline : preset.pipelines)
            EXPECT_TRUE(preset.isFor(parsePipeline(pipeline)));
        RenderSettings settings;
        EXPECT_NO_THROW(applyPreset(settings, preset.name));
        EXPECT_EQ(settings.jitter, preset.jitter);
        EXPECT_NE(assignmentsOf(settings), std::vector<std::string>()) << preset.name;
        // Histories follow what the first hit says.
        if (const denoise::Denoiser* denoiser = parsePipeline(preset.pipelines.front()).denoiser) {
            EXPECT_FALSE(settings.pathtrace.throughMirrors) << preset.name;
            EXPECT_EQ(settings.jitter, denoiser->network ? Jitter::Pixel : Jitter::Off);
        }
    }
}

TEST(Presets, TheCoursesHistoryRestartsFromGreyEverywhereAndTracksAnyObject) {
    RenderSettings settings;
    applyPreset(settings, "history-tracking-course");
    const denoise::HistorySettings& history = settings.denoisers.history;
    EXPECT_TRUE(history.greyRestart && history.greyMisses);
    EXPECT_EQ(history.grey, 0.5f);
    EXPECT_FALSE(history.identity || history.search || history.relative || history.demodulate);
    EXPECT_EQ(history.maxHistory, 0.0f);
}

TEST(Presets, TheJitterTutorialIsARunningMeanOfOneJitteredRayEach) {
    RenderSettings settings;
    applyPreset(settings, "jitter-camera-tutorial");
    EXPECT_EQ(settings.jitter, Jitter::Pixel);
    EXPECT_TRUE(settings.pathtrace.samplerTea);
    EXPECT_EQ(settings.samplesPerLaunch, 1u);
    EXPECT_TRUE(findPreset("jitter-camera-tutorial").progressive);
    for (const char* pipeline : {"path", "gbuffer", "ao"})
        EXPECT_THAT(findPreset("jitter-camera-tutorial").pipelines, Contains(pipeline));
}

TEST(Presets, ThePipelineIsTheAskedOneIfThePresetIsForIt) {
    const std::vector<std::string> none, course{"history-tracking-course"},
        both{"history-tracking-course", "svgf-paper"};
    EXPECT_EQ(pipelineFor(none, "", "path").name(), "path");
    EXPECT_EQ(pipelineFor(none, "svgf", "path").name(), "svgf");
    EXPECT_EQ(pipelineFor(course, "", "path").name(), "atrous");
    EXPECT_EQ(pipelineFor(course, "history", "path").name(), "history");
    EXPECT_THROW(pipelineFor(course, "path", "path"), UsageError);
    EXPECT_THROW(pipelineFor(both, "", "path"), UsageError);
    EXPECT_THROW(pipelineFor(none, "nothing", "path"), UsageError);
    try {
        pipelineFor(course, "kpcn", "path");
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_THAT(error.what(), HasSubstr("is not for 'kpcn', but for atrous history"));
    }
}

}  // namespace
}  // namespace limpid
