#include "studio/state/command_line.h"

#include <gmock/gmock.h>

#include "renderer/method/parameters.h"

namespace limpid::studio {
namespace {

using testing::HasSubstr;
using testing::Not;

class CommandLineTest : public testing::Test {
  protected:
    void frames(int count, bool moving) {
        for (int i = 0; i < count; ++i) {
            scene::CameraKey key;
            key.eye = {moving ? 0.1f * static_cast<float>(i) : 0.1f, 1.0f, 2.0f};
            playback_.advance({}, key);
        }
    }
    std::string text() const { return commandLineOf(frame_, playback_, "flown.json").text; }

    ShownFrame frame_{.source = {.scene = "my scene.glb",
                                 .environment = {},
                                 .lights = {},
                                 .background = {},
                                 .lightFile = {},
                                 .assetRoot = {}},
                      .clip = {},
                      .weights = {},
                      .settings = {},
                      .samples = 2,
                      .samplesInMean = 24,
                      .camera = {}};
    Playback playback_;
};

TEST_F(CommandLineTest, AStillHasItsCameraAndSamples) {
    frames(12, false);
    EXPECT_THAT(text(), HasSubstr("render 'my scene.glb' --integrator path --denoiser none"));
    EXPECT_THAT(text(), HasSubstr("--spp 24 --progressive"));
    EXPECT_THAT(text(), HasSubstr("--eye 0.1,1,2 --target 0,0,-1"));
    EXPECT_THAT(text(), HasSubstr("-o frame.exr"));
    EXPECT_THAT(text(), Not(HasSubstr("--frames")));
    EXPECT_THAT(text(), Not(HasSubstr("--set")));
}

TEST_F(CommandLineTest, AStillWithMotionBlurHasItsShutter) {
    frame_.shutter = {0.1, Shutter::Position::End};
    frames(1, false);
    EXPECT_THAT(
        text(),
        HasSubstr("--spp 24 --samples-per-launch 1 --fps 30 --shutter 0.1 --shutter-position end --anim"));
}

TEST_F(CommandLineTest, LightsAndLayersAreSaid) {
    frame_.source.lights = {"sun,0,1,0,2", "point,1,2,3,4"};
    frame_.source.background = "1,1,1";
    frame_.source.assetRoot = "my assets";
    frame_.settings.layers = true;
    frames(1, false);
    EXPECT_THAT(
        text(),
        HasSubstr("--light sun,0,1,0,2 --light point,1,2,3,4 --asset-root 'my assets' --background 1,1,1"));
    EXPECT_THAT(text(), HasSubstr("--aov all"));
}

/// The window keeps them, but `limpid render` refuses them.
TEST_F(CommandLineTest, ParametersWithoutEffectAreLeftOut) {
    assign(frame_.settings, "svgf.levels=3");
    assign(frame_.settings, "pathtrace.max_depth=12");
    frames(1, false);
    EXPECT_THAT(text(), HasSubstr("--set pathtrace.max_depth=12"));
    EXPECT_THAT(text(), Not(HasSubstr("svgf.levels")));
    for (const char* integrator : {"direct", "ao"}) {
        frame_.settings.pipeline = parsePipeline(integrator);
        EXPECT_THAT(text(), Not(HasSubstr("--set"))) << integrator;
    }
    frame_.settings.pipeline = parsePipeline("direct");
    assign(frame_.settings, "pathtrace.max_depth=0");
    EXPECT_THAT(text(), HasSubstr("--set pathtrace.max_depth=0"));
}

TEST_F(CommandLineTest, HistoriesNeedAllFrames) {
    frame_.settings.pipeline = parsePipeline("path", "svgf");
    assign(frame_.settings, "svgf.levels=3");
    frames(12, true);
    EXPECT_THAT(text(), HasSubstr("--integrator path --denoiser svgf"));
    EXPECT_THAT(text(), HasSubstr("--frames 12"));
    EXPECT_THAT(text(), HasSubstr("--camera-path flown.json"));
    EXPECT_THAT(text(), HasSubstr("--spp 2"));
    EXPECT_THAT(text(), HasSubstr("--set svgf.levels=3"));
    EXPECT_THAT(text(), HasSubstr("-o frame.%04d.exr"));
    EXPECT_TRUE(commandLineOf(frame_, playback_, "flown.json").needsPath);
    EXPECT_THAT(pathText(playback_, 45.0f), HasSubstr("\"time\""));
}

TEST_F(CommandLineTest, WhatCannotBeMadeAgainSaysWhy) {
    frame_.settings.pipeline = parsePipeline("path", "svgf");
    frame_.clip = "walk";
    playback_.playing = true;
    frames(3, false);
    EXPECT_EQ(commandLineOf(frame_, playback_, "").problem, "");
    playback_.playing = false;
    frames(2, false);
    EXPECT_THAT(commandLineOf(frame_, playback_, "").problem, HasSubstr("reset"));
    playback_.reset(0.0);
    playback_.playing = true;
    frames(2, false);
    playback_.noteOtherSettings();
    EXPECT_THAT(commandLineOf(frame_, playback_, "").problem, HasSubstr("settings"));
    frame_.settings.pipeline = {};
    EXPECT_EQ(commandLineOf(frame_, playback_, "").problem, "");
}

TEST_F(CommandLineTest, WordsOfAShell) {
    EXPECT_EQ(quoted("a/b-c.glb"), "a/b-c.glb");
    EXPECT_EQ(quoted("it's"), "'it'\\''s'");
    EXPECT_EQ(quoted(""), "''");
}

}  // namespace
}  // namespace limpid::studio
