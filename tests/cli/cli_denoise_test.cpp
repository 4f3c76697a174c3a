// Tests `limpid render` with pipelines that reuse frames, and `limpid denoise` on files of other renderers.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "image/io/exr/exr.h"
#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

using image::LayeredImage;
using testing::HasSubstr;
using testing::Not;

constexpr const char* small = " --device cpu --width 64 --height 36 ";
constexpr const char* tiny = " --device cpu --width 16 --height 9 ";

class CliDenoiseTest : public CliTest {
  protected:
    /// Renders noisy frames with every layer, as the pipelines trace them.
    void renderNoisy(const std::string& layers, const std::string& more = "") {
        const Result result =
            run("render builtin:cornell-moving -o " + path("noisy.%02d.exr") + small +
                "--spp 1 --jitter frame --float --frames 4 --camera-path shake --aov " + layers + more);
        ASSERT_EQ(result.code, 0) << result.output;
    }
};

TEST_F(CliDenoiseTest, GivesExactlyWhatTheRenderersOwnPipelineGives) {
    renderNoisy("all");
    for (const std::string method : {"temporal", "atrous"}) {
        const Result rendered = run("render builtin:cornell-moving -o " + path("own.%02d.exr") + small +
                                    "--float --frames 4 --camera-path shake --aov all --denoiser " + method);
        ASSERT_EQ(rendered.code, 0) << rendered.output;
        const Result denoised = run("denoise " + path("noisy.%02d.exr") + " -o " + path("clean.%02d.exr") +
                                    " --device cpu --denoiser " + method);
        ASSERT_EQ(denoised.code, 0) << denoised.output;
        for (int frame = 0; frame < 4; ++frame) {
            const std::string number = "0" + std::to_string(frame) + ".exr";
            const LayeredImage clean = image::readExr(path("clean." + number));
            EXPECT_EQ(clean.get("", "RGB").pixels,
                      image::readExr(path("own." + number)).get("", "RGB").pixels)
                << method << " frame " << frame;
            EXPECT_NE(clean.find("motion.X"), nullptr) << "the other layers stay";
            EXPECT_EQ(clean.metadata.at("limpid.jitter") == "0 0", frame == 0) << "so edges are smoothed";
            EXPECT_EQ(clean.metadata.at("limpid.denoiser"), method);
        }
    }
}

/// What only a filter reads is stored in halves.
TEST_F(CliDenoiseTest, PicturesWithoutTheirLayersDifferByLittle) {
    for (const std::string method : {"temporal", "atrous", "svgf", "nano", "film"}) {
        for (const std::string layers : {"", " --aov all"}) {
            const Result rendered =
                run("render builtin:cornell-moving -o " +
                    path(layers.empty() ? "alone.%02d.exr" : "with.%02d.exr") + small +
                    "--float --spp 1 --frames 4 --camera-path shake --denoiser " + method + layers);
            ASSERT_EQ(rendered.code, 0) << rendered.output;
        }
        const auto alone = image::readExr(path("alone.03.exr")).get("", "RGB").pixels;
        const auto with = image::readExr(path("with.03.exr")).get("", "RGB").pixels;
        double sum = 0.0, difference = 0.0;
        for (size_t i = 0; i < with.size(); ++i) {
            sum += double{with[i]};
            difference += std::abs(double{alone[i]} - double{with[i]});
        }
        fmt::print("{}: differs by {:.2g} of the mean\n", method, difference / sum);
        EXPECT_GT(difference, 0.0) << method << ": proves nothing";
        EXPECT_LT(difference, 1e-3 * sum) << method;
    }
}

/// The layers beside a denoised picture are the denoiser's input, whatever the integrator.
TEST_F(CliDenoiseTest, LayersOfDenoisedFramesCanBeDenoisedAgain) {
    for (const std::string integrator : {"ao", "direct"}) {
        const Result rendered = run(
            "render builtin:cornell-moving -o " + path("own.%02d.exr") + small +
            "--float --frames 3 --aov all --denoiser svgf --camera-path shake --integrator " + integrator);
        ASSERT_EQ(rendered.code, 0) << rendered.output;
        const Result denoised = run("denoise " + path("own.%02d.exr") + " -o " + path("again.%02d.exr") +
                                    " --device cpu --denoiser svgf");
        ASSERT_EQ(denoised.code, 0) << denoised.output;
        for (const std::string number : {"00.exr", "02.exr"}) {
            const LayeredImage own = image::readExr(path("own." + number));
            EXPECT_EQ(image::readExr(path("again." + number)).get("", "RGB").pixels,
                      own.get("", "RGB").pixels)
                << integrator << " frame " << number;
            EXPECT_EQ(own.metadata.at("limpid.integrator"), integrator);
            EXPECT_EQ(own.metadata.at("limpid.denoiser"), "svgf");
        }
    }
}

TEST_F(CliDenoiseTest, DirectLightIsOneBounce) {
    const auto picture = [&](const std::string& options) {
        const Result result = run("render builtin:cornell --spp 2 -o " + path("a.exr") + tiny + options);
        EXPECT_EQ(result.code, 0) << options << result.output;
        return image::readExr(path("a.exr")).get("", "RGB").pixels;
    };
    const auto direct = picture("--integrator direct");
    EXPECT_EQ(direct, picture("--max-depth 1"));
    EXPECT_EQ(direct, picture("--integrator direct --set pathtrace.max_depth=1"));
    EXPECT_NE(direct, picture("--max-depth 2"));
    EXPECT_EQ(picture("--integrator direct --max-depth 0"), picture("--max-depth 0"));
}

TEST_F(CliDenoiseTest, AStillNeedsNoMotion) {
    renderNoisy("diffuse,specular,emission,albedo,normal,depth");
    const Result result = run("denoise " + path("noisy.02.exr") + " -o " + path("clean.png") +
                              " --device cpu --denoiser atrous");
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_TRUE(fs::exists(path("clean.png")));
}

TEST_F(CliDenoiseTest, WhatIsMissingIsNamed) {
    renderNoisy("diffuse,emission,normal,depth");
    const std::string clean = " -o " + path("clean.%02d.exr") + " --device cpu --denoiser temporal";
    Result result = run("denoise " + path("noisy.%02d.exr") + clean);
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("the layer 'albedo' is missing: textures are blurred"));
    EXPECT_THAT(result.output,
                HasSubstr("the layer 'motion' is missing: it is searched by block matching on normals"));
    EXPECT_THAT(result.output, Not(HasSubstr("the layer 'normal'")));
    LayeredImage plain(image::readExr(path("noisy.01.exr")));
    plain.metadata["limpid.camera"] = "perspective origin 0 0 nan";
    image::writeExr(path("foreign.exr"), plain);
    result = run("denoise " + path("foreign.exr") + " -o " + path("clean.exr") + " --device cpu");
    EXPECT_EQ(result.code, 3);
    EXPECT_THAT(result.output, HasSubstr("is not a camera"));
    EXPECT_FALSE(fs::exists(path("clean.exr")));
    fs::remove(path("noisy.02.exr"));
    result = run("denoise " + path("noisy.%02d.exr") + clean);
    EXPECT_EQ(result.code, 3);
    EXPECT_THAT(result.output, HasSubstr("frame 2 is missing"));
    result = run("denoise " + path("noisy.%02d.exr") + clean + " --on-error skip");
    EXPECT_EQ(result.code, 0) << result.output;
    // Networks were trained with variances.
    result =
        run("denoise " + path("noisy.01.exr") + " -o " + path("clean.exr") + " --device cpu --denoiser kpcn");
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("variances are estimated from the neighbourhood"));
}

TEST_F(CliDenoiseTest, WrongUsageIsRefusedWithTheChoices) {
    Result result = run("denoise a.exr -o " + path("b.exr") + " --denoiser nlm");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("the denoisers are none svgf nano film kpcn"));
    result = run("render builtin:cornell -o " + path("a.png") + " --denoiser magic");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("the denoisers are none svgf nano film kpcn"));
    result = run("render builtin:cornell -o " + path("a.png") + " --integrator magic");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("the integrators are path direct ao gbuffer preview"));
    result = run("render builtin:cornell -o " + path("a.png") + " --integrator gbuffer --denoiser svgf");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("--integrator gbuffer takes no denoiser: it has no light signals"));
    result = run("denoise a.exr -o " + path("b.exr") + " --denoiser visibility");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("--denoiser visibility filters one channel"));
    result = run("bench quality --integrator preview --denoiser svgf");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("takes no denoiser"));
    result = run("render builtin:cornell -o " + path("a.png") + " --denoiser atrous --preset nice");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output,
                HasSubstr("the presets are ambient-occlusion-tutorial history-tracking-course"));
    // A preset describes a whole method, and a second one would override parts of it.
    result = run("render builtin:cornell -o " + path("a.png") +
                 " --preset history-tracking-course --preset ambient-occlusion-tutorial");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("--preset"));
    // The pipeline would ignore the preset.
    result = run("render builtin:cornell -o " + path("a.png") + " --denoiser kpcn --preset svgf-paper");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("svgf-paper: is not for --denoiser kpcn, but for svgf"));
    result = run("denoise a.exr -o " + path("b.exr") + " --preset jitter-camera-tutorial");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("--denoiser is missing"));
    result = run("denoise a.exr -o " + path("b.exr") + " --denoiser kpcn --preset svgf-cis565");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("is not for --denoiser kpcn"));
    result = run("bench quality --denoiser svgf --denoiser temporal --preset svgf-paper");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("is not for --denoiser temporal"));
    result = run("bench svgf --preset history-tracking-course");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("is not for --denoiser svgf"));
    result = run("render builtin:cornell -o " + path("a.png") + " --denoiser atrous --time-limit 3");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("are for --integrator path"));
    result = run("render builtin:cornell -o " + path("a.exr") + " --integrator ao --aov specular");
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("--integrator ao --denoiser none has no layer 'specular'"));
}

TEST_F(CliDenoiseTest, FormerSpellingsNameTheNewOnes) {
    const auto expect = [&](const std::string& options, const std::string& message) {
        const Result result = run(options);
        EXPECT_EQ(result.code, 2) << options;
        EXPECT_THAT(result.output, HasSubstr(message)) << options;
    };
    const std::string render = "render builtin:cornell -o " + path("a.png");
    expect(render + " --pipeline svgf", "--pipeline svgf is now --denoiser svgf");
    expect(render + " --pipeline ao", "--pipeline ao is now --integrator ao");
    expect("render builtin:cornell --pipeline path", "--pipeline path is now --integrator path");
    expect(render + " --pipeline history", "--pipeline history is now --denoiser temporal");
    expect(render + " --denoiser history", "--denoiser history is now --denoiser temporal");
    expect("bench quality --denoiser history", "--denoiser history is now --denoiser temporal");
    expect("denoise a.exr -o b.exr --denoiser history", "--denoiser history is now --denoiser temporal");
    expect("denoise a.exr -o b.exr --method history", "--method history is now --denoiser temporal");
    expect(render + " --pipeline magic", "--pipeline is now --integrator (what is computed) and --denoiser");
    expect("view builtin:cornell --pipeline gbuffer", "--pipeline gbuffer is now --integrator gbuffer");
    expect("bench denoise --pipeline atrous", "--pipeline atrous is now --denoiser atrous");
    expect("bench quality --pipeline svgf --pipeline kpcn", "--pipeline svgf is now --denoiser svgf");
    expect("denoise a.exr -o b.exr --method kpcn", "--method kpcn is now --denoiser kpcn");
    expect("denoise a.exr -o b.exr --method nlm", "--method is now --denoiser, one of none");
    expect(render + " --tracer pipeline", "--tracer pipeline is now --tracer hardware");
    expect(render + " --tracer magic", "the tracers are auto compute hardware");
    for (const char* command : {"render", "denoise", "view", "bench quality"})
        EXPECT_THAT(run(std::string(command) + " --help").output,
                    Not(testing::AnyOf(HasSubstr("--pipeline"), HasSubstr("--method"))));
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
              picture("--spp 3 --sampler pcg --jitter off --progressive"));
    EXPECT_EQ(picture(tutorial + "--integrator gbuffer"),
              picture("--spp 3 --integrator gbuffer --sampler tea"));
    EXPECT_EQ(picture("--preset svgf-paper --set svgf.levels=2"),
              picture("--denoiser svgf --preset svgf-paper --set svgf.levels=2"));
    EXPECT_NE(picture("--preset svgf-paper"), picture("--preset svgf-paper --set svgf.levels=2"));
}

TEST_F(CliDenoiseTest, TimesOfEveryPassAndFailureCasesAreReported) {
    const Result result = run("render builtin:cornell-moving -o " + path("a.%d.exr") + small +
                              "--denoiser atrous --frames 3 --json --dump temporal/accumulate");
    ASSERT_EQ(result.code, 0) << result.output;
    const auto json = nlohmann::json::parse(result.output.substr(result.output.find('{')));
    for (const char* pass : {"pathtrace", "temporal/accumulate", "atrous/level 5", "atrous/compose"})
        EXPECT_GT(json["median_ms"][pass].get<double>(), 0.0) << pass;
    EXPECT_GT(json["disocclusion"]["nothing_hit"].get<int>(), 0);
    EXPECT_EQ(json["disocclusion"]["rejected"], 0);
    for (const char* image : {"color", "disocclusion", "color.previous"})
        EXPECT_TRUE(fs::exists(path(std::string("a.2.temporal.") + image + ".exr"))) << image;
}

TEST_F(CliDenoiseTest, GBufferAndAmbientOcclusionAreRendered) {
    for (const std::string integrator : {"gbuffer", "ao"}) {
        const Result result = run("render builtin:cornell -o " + path(integrator + ".exr") + small +
                                  "--spp 4 --aov all --integrator " + integrator);
        ASSERT_EQ(result.code, 0) << result.output;
        const LayeredImage picture = image::readExr(path(integrator + ".exr"));
        EXPECT_NE(picture.find("normal.X"), nullptr);
        EXPECT_EQ(picture.find("specular.R"), nullptr);
        const image::Image beauty = picture.get("", "RGB");
        for (const float value : beauty.pixels) {
            EXPECT_GE(value, 0.0f);
            EXPECT_LE(value, integrator == "ao" ? 1.0f : 1e6f);
        }
    }
}

}  // namespace
}  // namespace limpid
