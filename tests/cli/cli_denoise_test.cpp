// limpid render with pipelines that go from frame to frame, and limpid denoise on the files of others.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "image/io/exr/exr.h"
#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

using image::LayeredImage;
using testing::HasSubstr;

constexpr const char* small = " --device cpu --width 64 --height 36 ";
constexpr const char* tiny = " --device cpu --width 16 --height 9 ";

class CliDenoiseTest : public CliTest {
  protected:
    /// Noisy frames with every layer, as the pipelines trace them.
    void renderNoisy(const std::string& layers, const std::string& more = "") {
        const Result result =
            run("render builtin:cornell-moving -o " + path("noisy.%02d.exr") + small +
                "--spp 1 --jitter off --float --frames 4 --camera-path shake --aov " + layers + more);
        ASSERT_EQ(result.code, 0) << result.output;
    }
};

TEST_F(CliDenoiseTest, GivesExactlyWhatTheRenderersOwnPipelineGives) {
    renderNoisy("all");
    for (const std::string method : {"history", "atrous"}) {
        const Result rendered = run("render builtin:cornell-moving -o " + path("own.%02d.exr") + small +
                                    "--float --frames 4 " + "--camera-path shake --pipeline " + method);
        ASSERT_EQ(rendered.code, 0) << rendered.output;
        const Result denoised = run("denoise " + path("noisy.%02d.exr") + " -o " + path("clean.%02d.exr") +
                                    " --device cpu --method " + method);
        ASSERT_EQ(denoised.code, 0) << denoised.output;
        for (int frame = 0; frame < 4; ++frame) {
            const std::string number = "0" + std::to_string(frame) + ".exr";
            const LayeredImage clean = image::readExr(path("clean." + number));
            EXPECT_EQ(clean.get("", "RGB").pixels,
                      image::readExr(path("own." + number)).get("", "RGB").pixels)
                << method << " frame " << frame;
            EXPECT_NE(clean.find("motion.X"), nullptr) << "the other layers stay";
            EXPECT_EQ(clean.metadata.at("limpid.denoiser"), method);
        }
    }
}

TEST_F(CliDenoiseTest, AStillNeedsNoMotion) {
    renderNoisy("diffuse,specular,emission,albedo,normal,depth");
    const Result result =
        run("denoise " + path("noisy.02.exr") + " -o " + path("clean.png") + " --device cpu --method atrous");
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(fs::exists(path("clean.png")));
}

TEST_F(CliDenoiseTest, WhatIsMissingIsNamed) {
    renderNoisy("diffuse,emission,normal,depth");
    Result result = run("denoise " + path("noisy.%02d.exr") + " -o " + path("clean.%02d.exr") +
                        " --device cpu --method history");
    EXPECT_EQ(result.code, 3);
    EXPECT_THAT(result.output, HasSubstr("noisy.00.exr: lacks the layers specular, albedo, motion"));
    EXPECT_FALSE(fs::exists(path("clean.00.exr")));
    LayeredImage plain(image::readExr(path("noisy.01.exr")));
    plain.metadata.clear();
    for (const char* layer : {"specular", "albedo"})
        plain.add(layer, "RGB", image::Image(64, 36, 3, 0.5f), image::Storage::Half);
    image::writeExr(path("foreign.exr"), plain);
    result =
        run("denoise " + path("foreign.exr") + " -o " + path("clean.exr") + " --device cpu --method history");
    EXPECT_EQ(result.code, 3);
    EXPECT_THAT(result.output, HasSubstr("foreign.exr: lacks the attribute 'limpid.camera'"));
    plain.metadata["limpid.camera"] = "perspective origin 0 0 nan";
    image::writeExr(path("foreign.exr"), plain);
    result =
        run("denoise " + path("foreign.exr") + " -o " + path("clean.exr") + " --device cpu --method history");
    EXPECT_EQ(result.code, 3);
    EXPECT_THAT(result.output, HasSubstr("is not a camera"));
    fs::remove(path("noisy.02.exr"));
    result = run("denoise " + path("noisy.%02d.exr") + " -o " + path("clean.%02d.exr") +
                 " --device cpu --method history");
    EXPECT_EQ(result.code, 3);
    EXPECT_THAT(result.output, HasSubstr("frame 2 is missing"));
}

TEST_F(CliDenoiseTest, WrongUsageIsRefusedWithTheChoices) {
    Result result = run("denoise a.exr -o " + path("b.exr") + " --method nlm");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("the methods are history atrous"));
    result = run("render builtin:cornell -o " + path("a.png") + " --pipeline magic");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("the pipelines are path gbuffer ao preview history atrous"));
    result = run("render builtin:cornell -o " + path("a.png") + " --pipeline atrous --preset nice");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output,
                HasSubstr("the presets are ambient-occlusion-tutorial history-tracking-course"));
    // A preset that the pipeline would ignore.
    result = run("render builtin:cornell -o " + path("a.png") + " --pipeline kpcn --preset svgf-paper");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("svgf-paper: is not for 'kpcn', but for svgf"));
    result = run("denoise a.exr -o " + path("b.exr") + " --preset jitter-camera-tutorial");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("--method is missing"));
    result = run("denoise a.exr -o " + path("b.exr") + " --method kpcn --preset svgf-cis565");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("is not for 'kpcn'"));
    result = run("bench quality --pipeline svgf --pipeline history --preset svgf-paper");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("is not for 'history'"));
    result = run("bench svgf --preset history-tracking-course");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("is not for 'svgf'"));
    result = run("render builtin:cornell -o " + path("a.png") + " --pipeline atrous --time-limit 3");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("are for --pipeline path"));
    result = run("render builtin:cornell -o " + path("a.exr") + " --pipeline ao --aov specular");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("the pipeline 'ao' has no layer 'specular'"));
}

TEST_F(CliDenoiseTest, APresetIsAllThatItsSourceSaysAndOtherOptionsWin) {
    const auto picture = [&](const std::string& options) {
        const Result result = run("render builtin:cornell -o " + path("a.exr") + tiny + options);
        EXPECT_EQ(result.code, 0) << options << result.output;
        return image::readExr(path("a.exr")).get("", "RGB").pixels;
    };
    const std::string tutorial = "--spp 3 --preset jitter-camera-tutorial ";
    EXPECT_EQ(picture(tutorial), picture("--spp 3 --jitter pixel --sampler tea --progressive"));
    EXPECT_EQ(picture(tutorial + "--sampler pcg --jitter off"),
              picture("--spp 3 --jitter off --progressive"));
    EXPECT_EQ(picture(tutorial + "--pipeline gbuffer"), picture("--spp 3 --pipeline gbuffer --sampler tea"));
    EXPECT_EQ(picture("--preset svgf-paper --set svgf.levels=2"),
              picture("--pipeline svgf --preset svgf-paper --set svgf.levels=2"));
    EXPECT_NE(picture("--preset svgf-paper"), picture("--preset svgf-paper --set svgf.levels=2"));
}

TEST_F(CliDenoiseTest, TimesOfEveryPassAndFailureCasesAreReported) {
    const Result result = run("render builtin:cornell-moving -o " + path("a.%d.exr") + small +
                              "--pipeline atrous --frames 3 --json --dump history/track");
    ASSERT_EQ(result.code, 0) << result.output;
    const auto json = nlohmann::json::parse(result.output.substr(result.output.find('{')));
    for (const char* pass : {"pathtrace", "history/track", "atrous/level 5", "atrous/modulate"})
        EXPECT_GT(json["median_ms"][pass].get<double>(), 0.0) << pass;
    EXPECT_GT(json["history"]["nothing_hit"].get<int>(), 0);
    EXPECT_EQ(json["history"]["rejected"], 0);
    for (const char* image : {"color", "normal_depth", "albedo_id", "cases"})
        EXPECT_TRUE(fs::exists(path(std::string("a.2.history.") + image + ".exr"))) << image;
    for (const char* image : {"color", "normal_depth", "albedo_id"})
        EXPECT_TRUE(fs::exists(path(std::string("a.2.history.") + image + ".previous.exr"))) << image;
}

TEST_F(CliDenoiseTest, GBufferAndAmbientOcclusionAreRendered) {
    for (const std::string pipeline : {"gbuffer", "ao"}) {
        const Result result = run("render builtin:cornell -o " + path(pipeline + ".exr") + small +
                                  "--spp 4 --aov all --pipeline " + pipeline);
        ASSERT_EQ(result.code, 0) << result.output;
        const LayeredImage picture = image::readExr(path(pipeline + ".exr"));
        EXPECT_NE(picture.find("normal.X"), nullptr);
        EXPECT_EQ(picture.find("specular.R"), nullptr);
        const image::Image beauty = picture.get("", "RGB");
        for (const float value : beauty.pixels) {
            EXPECT_GE(value, 0.0f);
            EXPECT_LE(value, pipeline == "ao" ? 1.0f : 1e6f);
        }
    }
}

}  // namespace
}  // namespace limpid
