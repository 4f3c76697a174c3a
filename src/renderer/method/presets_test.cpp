#include "renderer/method/presets.h"

#include <gmock/gmock.h>

#include <set>

#include "base/error.h"
#include "renderer/method/parameters.h"

namespace limpid {
namespace {

using testing::Contains;
using testing::HasSubstr;

TEST(Presets, SayAllThatTheyNeedAndOnlyWhatThereIs) {
    std::set<std::string> names;
    for (const Preset& preset : presets()) {
        EXPECT_TRUE(names.insert(preset.name).second) << preset.name;
        EXPECT_GT(preset.help.size(), 20u);
        ASSERT_FALSE(preset.integrators.empty() || preset.denoisers.empty());
        for (const std::string& integrator : preset.integrators) {
            for (const std::string& denoiser : preset.denoisers)
                EXPECT_TRUE(preset.isFor(parsePipeline(integrator, denoiser)));
        }
        RenderSettings settings;
        EXPECT_NO_THROW(applyPreset(settings, preset.name));
        EXPECT_EQ(settings.jitter, preset.jitter);
        EXPECT_NE(settings.pathtrace.sampler(), Sampler::Sobol) << preset.name;
        EXPECT_NE(assignmentsOf(settings), std::vector<std::string>()) << preset.name;
        // Histories follow the first hit.
        if (const denoise::Denoiser* denoiser = preset.pipeline().denoiser) {
            EXPECT_FALSE(settings.pathtrace.throughMirrors) << preset.name;
            EXPECT_FALSE(settings.pathtrace.throughGlass) << preset.name;
            EXPECT_EQ(settings.jitter, denoiser->network ? Jitter::Pixel : Jitter::Off);
        }
    }
}

TEST(Presets, OneAfterAnotherIsTheOther) {
    for (const Preset& first : presets()) {
        for (const Preset& second : presets()) {
            RenderSettings both, alone;
            applyOnlyPreset(both, first.name);
            applyOnlyPreset(both, second.name);
            applyOnlyPreset(alone, second.name);
            EXPECT_EQ(assignmentsOf(both), assignmentsOf(alone)) << first.name << ", " << second.name;
            EXPECT_EQ(both.jitter, alone.jitter);
        }
    }
}

TEST(Presets, TheCoursesHistoryRestartsFromGreyEverywhereAndTracksAnyObject) {
    RenderSettings settings;
    applyPreset(settings, "history-tracking-course");
    const denoise::TemporalSettings& temporal = settings.denoisers.temporal;
    EXPECT_TRUE(temporal.greyRestart && temporal.greyMisses);
    EXPECT_EQ(temporal.grey, 0.5f);
    EXPECT_FALSE(temporal.identity || temporal.search || temporal.relative || temporal.demodulate);
    EXPECT_EQ(temporal.maxHistory, 0.0f);
}

TEST(Presets, TheJitterTutorialIsARunningMeanOfOneJitteredRayEach) {
    RenderSettings settings;
    applyPreset(settings, "jitter-camera-tutorial");
    EXPECT_EQ(settings.jitter, Jitter::Pixel);
    EXPECT_TRUE(settings.pathtrace.samplerTea);
    EXPECT_EQ(settings.samplesPerLaunch, 1u);
    EXPECT_TRUE(findPreset("jitter-camera-tutorial").progressive);
    for (const char* integrator : {"path", "gbuffer", "ao"})
        EXPECT_THAT(findPreset("jitter-camera-tutorial").integrators, Contains(integrator));
}

std::string faultOf(const std::string& preset, const PipelineChoice& asked) {
    try {
        pipelineFor(preset, asked, {});
    } catch (const UsageError& error) {
        return error.what();
    }
    return "none";
}

TEST(Presets, WhatIsAskedForWinsOverPresetsAndDefaults) {
    const std::string none, course = "history-tracking-course";
    const Pipeline kept = parsePipeline("ao", "svgf");
    EXPECT_EQ(pipelineFor(none, {}, {}), Pipeline{});
    EXPECT_EQ(pipelineFor(none, {}, kept), kept);
    EXPECT_EQ(pipelineFor(none, {"", "atrous"}, kept), parsePipeline("ao", "atrous"));
    EXPECT_EQ(pipelineFor(none, {"direct", ""}, kept), parsePipeline("direct", "svgf"));
    EXPECT_EQ(pipelineFor(course, {}, {}), parsePipeline("path", "atrous"));
    EXPECT_EQ(pipelineFor(course, {"ao", "temporal"}, {}), parsePipeline("ao", "temporal"));
    EXPECT_THAT(faultOf(none, {"nothing", ""}),
                HasSubstr("the integrators are path direct ao gbuffer preview"));
    EXPECT_THAT(faultOf(none, {"", "nothing"}), HasSubstr("the denoisers are none svgf nano film kpcn"));
}

TEST(Presets, AnIntegratorThatTakesNoDenoiserIsRefusedOnlyWhereBothAreAskedFor) {
    const std::string none;
    EXPECT_EQ(pipelineFor(none, {"gbuffer", ""}, parsePipeline("path", "svgf")), parsePipeline("gbuffer"));
    EXPECT_EQ(pipelineFor(none, {"", "svgf"}, parsePipeline("preview")), parsePipeline("path", "svgf"));
    EXPECT_THAT(faultOf(none, {"gbuffer", "svgf"}), HasSubstr("--integrator gbuffer takes no denoiser"));
    EXPECT_THAT(faultOf(none, {"preview", "svgf"}), HasSubstr("it has no noise"));
}

TEST(Presets, ADenoiserOfOneChannelIsForAmbientOcclusion) {
    const std::string none;
    EXPECT_EQ(pipelineFor(none, {"", "visibility"}, {}), parsePipeline("ao", "visibility"));
    EXPECT_EQ(pipelineFor(none, {"path", ""}, parsePipeline("ao", "visibility")), parsePipeline("path"));
    EXPECT_THAT(faultOf(none, {"path", "visibility"}),
                HasSubstr("--denoiser visibility is not for --integrator path"));
    EXPECT_THAT(faultOf(none, {"gbuffer", "visibility"}), HasSubstr("takes no denoiser"));
}

TEST(Presets, AreRefusedWhereTheyWouldBeIgnored) {
    EXPECT_THAT(faultOf("history-tracking-course", {"", "kpcn"}),
                HasSubstr("is not for --denoiser kpcn, but for atrous temporal"));
    EXPECT_THAT(faultOf("svgf-paper", {"", "none"}), HasSubstr("is not for --denoiser none, but for svgf"));
    EXPECT_THAT(faultOf("svgf-paper", {"gbuffer", ""}),
                HasSubstr("is not for --integrator gbuffer, but for path direct ao"));
    EXPECT_THAT(faultOf("nice", {}), HasSubstr("there is no preset 'nice'"));
}

}  // namespace
}  // namespace limpid
