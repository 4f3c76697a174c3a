// Tests the network on the command line: its weights, the layers it needs, and that it denoises.
#include <gmock/gmock.h>

#include "image/io/exr/exr.h"
#include "image/metrics/metrics.h"
#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string smallWeights =
    " --weights '" + std::string(LIMPID_SOURCE_DIR) + "/tests/data/kpcn_small.safetensors' ";
constexpr const char* small = " --device cpu --width 48 --height 32 --float ";
constexpr const char* larger = " --device cpu --width 96 --height 64 --float ";

class CliKpcnTest : public CliTest {
  protected:
    image::Image pictureOf(const std::string& file) { return image::readExr(path(file)).get("", "RGB"); }
    void mustRun(const std::string& command) {
        const Result result = run(command);
        ASSERT_EQ(result.code, 0) << result.output;
    }
};

TEST_F(CliKpcnTest, TheShippedNetworkCleansAFrame) {
    // The networks were trained on independent numbers, and the limits are shares of their noise.
    mustRun("render builtin:cornell -o " + path("noisy.exr") + larger +
            "--spp 32 --sampler pcg --jitter off --aov all");
    mustRun("render builtin:cornell -o " + path("truth.exr") + larger + "--spp 1024 --seed 3 --jitter off");
    mustRun("denoise " + path("noisy.exr") + " -o " + path("clean.exr") + " --device cpu --denoiser kpcn");
    const image::Image truth = pictureOf("truth.exr");
    const double noisy = image::relMse(pictureOf("noisy.exr"), truth);
    EXPECT_LT(image::relMse(pictureOf("clean.exr"), truth), 0.15 * noisy);
    // The network of the course also needs no --weights.
    mustRun("denoise " + path("noisy.exr") + " -o " + path("course.exr") +
            " --device cpu --preset kpcn-cis565");
    const double course = image::relMse(pictureOf("course.exr"), truth);
    RecordProperty("course_over_noisy", std::to_string(course / noisy));
    EXPECT_LT(course, 0.6 * noisy);
    EXPECT_NE(course, image::relMse(pictureOf("clean.exr"), truth));
}

/// Compares with a mean over the pixels' areas, on a scene with many edges. Earlier, all samples went through
/// the pixels' centres, which gave jagged edges whatever --jitter said.
TEST_F(CliKpcnTest, StillsHaveSmoothEdges) {
    const std::string scene = "render builtin:lab-disocclusion" + std::string(small) + "-o ";
    mustRun(scene + path("truth.exr") + " --spp 192 --samples-per-launch 4 --seed 3");
    const auto psnrOf = [&](const std::string& more) {
        mustRun(scene + path("own.exr") + " --denoiser kpcn" + more);
        return image::psnr(image::displayEncode(pictureOf("own.exr"), 0.0f),
                           image::displayEncode(pictureOf("truth.exr"), 0.0f));
    };
    const double smooth = psnrOf(""), stepped = psnrOf(" --jitter off");
    RecordProperty("smooth_dB", std::to_string(smooth));
    RecordProperty("stepped_dB", std::to_string(stepped));
    EXPECT_GT(smooth, stepped + 6.0);  // 33.2 and 21.8
    EXPECT_EQ(psnrOf(" --jitter pixel"), smooth) << "the default";
    EXPECT_NE(psnrOf(" --jitter frame"), stepped);
}

/// With few samples, and with enough samples for kpcn.errors.
TEST_F(CliKpcnTest, RendersWhatDenoiseMakesOfItsFrames) {
    for (const std::string samples : {"--spp 4 ", "--spp 8 "}) {
        const std::string errors = "--set kpcn.errors=2";
        mustRun("render builtin:cornell -o " + path("noisy.exr") + small + samples +
                "--jitter off --aov all");
        mustRun("denoise " + path("noisy.exr") + " -o " + path("clean.exr") +
                " --device cpu --denoiser kpcn " + errors + smallWeights);
        mustRun("render builtin:cornell -o " + path("own.exr") + small + samples +
                "--jitter off --denoiser kpcn " + errors + smallWeights);
        mustRun("denoise " + path("noisy.exr") + " -o " + path("free.exr") +
                " --device cpu --denoiser kpcn --set kpcn.errors=0" + smallWeights);
        const image::Image clean = pictureOf("clean.exr"), own = pictureOf("own.exr");
        for (size_t i = 0; i < own.pixels.size(); ++i)
            ASSERT_NEAR(clean.pixels[i], own.pixels[i], 2e-3f * own.pixels[i] + 1e-4f) << samples << i;
        EXPECT_NE(own.pixels, pictureOf("noisy.exr").pixels);
        EXPECT_EQ(clean.pixels == pictureOf("free.exr").pixels, samples == "--spp 4 ");
    }
}

TEST_F(CliKpcnTest, VariancesAreEstimatedWhereAFileHasNone) {
    const std::string render = "render builtin:cornell-spheres" + std::string(larger) + "--jitter off -o ";
    mustRun(render + path("with.exr") + " --spp 8 --aov all");
    mustRun(render + path("without.exr") + " --spp 8 --aov diffuse,specular,emission,albedo,normal,depth");
    mustRun(render + path("truth.exr") + " --spp 512 --seed 3");
    const auto denoised = [&](const std::string& name) {
        return run("denoise " + path(name) + " -o " + path("clean.exr") + " --device cpu --denoiser kpcn");
    };
    const image::Image truth = pictureOf("truth.exr");
    EXPECT_THAT(denoised("with.exr").output, Not(HasSubstr("are estimated")));
    const double known = image::relMse(pictureOf("clean.exr"), truth);
    EXPECT_THAT(denoised("without.exr").output,
                HasSubstr("variances are estimated from the neighbourhood: no layers are known for those of "
                          "diffuse, specular, albedo, normal, depth"));
    const double estimated = image::relMse(pictureOf("clean.exr"), truth);
    const double noisy = image::relMse(pictureOf("without.exr"), truth);
    RecordProperty("noisy", std::to_string(noisy));
    RecordProperty("known", std::to_string(known));
    RecordProperty("estimated", std::to_string(estimated));
    EXPECT_LT(estimated, 1.1 * known);
    EXPECT_LT(estimated, 0.3 * noisy);
    EXPECT_NE(estimated, known);
    const std::string explain = "denoise --explain --denoiser kpcn ";
    EXPECT_THAT(run(explain + path("without.exr")).output, HasSubstr("are estimated"));
    EXPECT_THAT(run(explain + path("with.exr")).output, Not(HasSubstr("are estimated")));
}

TEST_F(CliKpcnTest, BadWeightsAreRefused) {
    const std::string render =
        "render builtin:cornell -o " + path("own.exr") + small + "--denoiser kpcn --weights ";
    put("weights", "not weights at all");
    for (const std::string& file : {path("weights"), path("none")}) {
        const Result result = run(render + file);
        EXPECT_EQ(result.code, 3);
        EXPECT_THAT(result.output, HasSubstr(file));
    }
    const Result result =
        run("render builtin:cornell -o " + path("own.exr") + small + "--denoiser svgf" + smallWeights);
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.output, HasSubstr("only kpcn"));
}

TEST_F(CliKpcnTest, InfoSaysHowItRuns) {
    EXPECT_THAT(run("info").output, HasSubstr("--denoiser kpcn"));
    EXPECT_THAT(run("info --json").output, HasSubstr("\"kpcn\": \""));
}

}  // namespace
}  // namespace limpid
