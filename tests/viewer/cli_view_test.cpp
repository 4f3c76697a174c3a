// Tests the window on a display without a screen (Xvfb).
#include <gmock/gmock.h>

#include <numeric>

#include "image/io/picture.h"
#include "image/metrics/metrics.h"
#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

using testing::HasSubstr;

double meanOf(const image::Image& picture) {
    return std::accumulate(picture.pixels.begin(), picture.pixels.end(), 0.0) /
           static_cast<double>(picture.pixels.size());
}

class CliViewTest : public CliTest {
  protected:
    void SetUp() override {
        CliTest::SetUp();
        if (run("view --help").output.find("--screenshot") == std::string::npos ||
            run("view builtin:none").output.find("was built without") != std::string::npos)
            GTEST_SKIP() << "NOT TESTED: Limpid was built without libglfw3-dev and libimgui-dev.";
    }
    /// Runs `limpid view` on a display, with validation.
    static Result onDisplay(const std::string& arguments) {
        if (runProgram("command -v xvfb-run").code != 0)
            return {77, "NOT TESTED: xvfb-run is missing (Debian packages xvfb and xauth)"};
        // Each process searches for a free display from its own number on, since two that search at the same
        // time may find the same one.
        const std::string first = std::to_string(1000 + ::getpid() % 20000);
        return runProgram("LIMPID_VALIDATION=1 xvfb-run -a -n " + first + " '" + LIMPID_PROGRAM + "' " +
                          arguments + " --settings none");
    }
};

TEST_F(CliViewTest, WithoutADisplayItSaysWhatToUseInstead) {
    const Result result = runProgram(std::string("env -u DISPLAY -u WAYLAND_DISPLAY '") + LIMPID_PROGRAM +
                                     "' view builtin:cornell");
    EXPECT_EQ(result.code, 1);
    EXPECT_THAT(result.output, HasSubstr("no display"));
    EXPECT_THAT(result.output, HasSubstr("limpid render"));
}

TEST_F(CliViewTest, WhatIsWrongWithTheSceneNeedsNoWindow) {
    expect("view builtin:none", 2, "there is no scene");
    expect("view '" + path("none.gltf") + "'", 3, "none.gltf");
    expect("view builtin:cornell --camera none", 2, "no camera");
}

TEST_F(CliViewTest, ShowsWhatRenderRenders) {
    const std::string scene = "builtin:cornell --device cpu --width 160 --height 120 ";
    const Result shown = onDisplay("view " + scene + "--frames 16 --screenshot '" + path("view.png") + "'");
    if (shown.code == 77) GTEST_SKIP() << shown.output;
    ASSERT_EQ(shown.code, 0) << shown.output;
    expect("render " + scene + "--spp 16 -o '" + path("render.png") + "'", 0, "");
    const image::Image view = image::readPicture(path("view.png")).linear,
                       render = image::readPicture(path("render.png")).linear;
    ASSERT_EQ(view.width, 160u);
    ASSERT_EQ(view.height, 120u);
    EXPECT_GT(image::psnr(view, render), 30.0);  // the exposure was measured on the first frame
}

TEST_F(CliViewTest, EveryIntegratorAndDenoiserIsShown) {
    for (const std::string options :
         {"--integrator gbuffer", "--integrator direct", "--integrator ao", "--integrator ao --denoiser svgf",
          "--denoiser temporal", "--denoiser atrous", "--denoiser svgf"}) {
        const std::string picture = path("shown.png");
        fs::remove(picture);
        const Result shown =
            onDisplay("view builtin:cornell-moving --device cpu --width 96 --height 64 --frames 6 " +
                      options + " --screenshot '" + picture + "'");
        if (shown.code == 77) GTEST_SKIP() << shown.output;
        EXPECT_EQ(shown.code, 0) << options << "\n" << shown.output;
        ASSERT_TRUE(fs::exists(picture)) << options;
        EXPECT_GT(meanOf(image::readPicture(picture).linear), 0.05) << options;
    }
}

}  // namespace
}  // namespace limpid
