// Tests how the program talks and ends: help, suggestions, previews, Ctrl-C.
#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <sstream>
#include <thread>

#include "image/io/png/png.h"
#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

using testing::HasSubstr;

class CliMannersTest : public CliTest {
  protected:
    /// Starts `limpid` with these words, sends it a signal when `file` exists, and returns how it ended.
    int interruptOnceThere(const std::string& words, const std::string& file) const {
        const std::string command =
            std::string("exec '") + LIMPID_PROGRAM + "' " + words + " >" + path("log") + " 2>&1";
        const pid_t process = ::fork();
        if (process == 0) {
            ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
            std::_Exit(127);
        }
        for (int i = 0; i < 1200 && !fs::exists(path(file)); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(25));
        ::kill(process, SIGINT);
        int status = 0;
        ::waitpid(process, &status, 0);
        return status;
    }
    static bool endedBy(int status, int signal) { return WIFSIGNALED(status) && WTERMSIG(status) == signal; }
};

TEST_F(CliMannersTest, HelpHasGroupsAndLinesOfAHundredColumns) {
    for (const char* command : {"", "render", "denoise", "view", "compare", "merge", "dataset", "info"}) {
        std::istringstream help(run(std::string(command) + " --help").output);
        for (std::string line; std::getline(help, line);)
            EXPECT_LE(line.size(), 100u) << command << ": " << line;
    }
    const std::string help = run("render --help").output;
    for (const char* group :
         {"\nScene and camera:\n", "\nOutput:\n", "\nSampling:\n", "\nMethod:\n", "\nLong renders:\n"})
        EXPECT_THAT(help, HasSubstr(group));
    EXPECT_THAT(help, HasSubstr("--sampler pcg|sobol|tea"));
    EXPECT_THAT(help, HasSubstr("[0.01 to 179]"));
}

TEST_F(CliMannersTest, MistypedWordsGetASuggestion) {
    expect("rendr builtin:cornell", 2, "Did you mean 'render'?");
    expect("render builtin:cornell --widht 3 -o " + path("a.png"), 2, "Did you mean --width?");
    expect("render builtin:cornell --set pathtrace.max_dept=3 -o " + path("a.png"), 2,
           "did you mean 'pathtrace.max_depth'?");
    const Result other = run("render builtin:cornell --frobnicate -o " + path("a.png"));
    EXPECT_EQ(other.output.find("Did you mean"), std::string::npos) << other.output;
}

TEST_F(CliMannersTest, AParameterThatTakesNoPartIsRefused) {
    expect("render builtin:cornell --set svgf.alpha=0.1 -o " + path("a.png"), 2,
           "--integrator path --denoiser none has no parameters of this group");
    expect("render builtin:cornell --denoiser svgf --set atrous.levels=2 -o " + path("a.png"), 2,
           "it has those of pathtrace svgf taa");
    expect("denoise a.exr -o b.exr --set pathtrace.max_depth=2", 2, "svgf has no parameters of this group");
}

TEST_F(CliMannersTest, ASceneAloneOpensTheWindow) {
    const Result result = runProgram(std::string("env -u DISPLAY -u WAYLAND_DISPLAY '") + LIMPID_PROGRAM +
                                     "' builtin:none-such");
    EXPECT_THAT(result.output, HasSubstr("there is no scene 'builtin:none-such'"));
    expect("missing.glb --frames 1", 3, "missing.glb");
}

TEST_F(CliMannersTest, AnInterruptedStillIsWrittenWithWhatItHas) {
    const int status = interruptOnceThere(
        "render builtin:cornell --width 64 --height 36 --spp 1000000 --device cpu --preview -o " +
            path("a.exr"),
        "a.preview.png");
    EXPECT_TRUE(endedBy(status, SIGINT)) << status;
    EXPECT_TRUE(fs::exists(path("a.exr")));
    EXPECT_EQ(image::readPngOrJpeg(path("a.preview.png")).width, 64u);
    EXPECT_THAT(get("log"), HasSubstr("interrupted: the picture has"));
    EXPECT_THAT(get("log"), HasSubstr("wrote " + path("a.exr")));
}

TEST_F(CliMannersTest, AnInterruptedSequenceKeepsItsFrames) {
    const int status = interruptOnceThere(
        "render builtin:cornell-moving --width 32 --height 18 --frames 100000 --denoiser svgf --device cpu "
        "-o " +
            path("a.%04d.png"),
        "a.0003.png");
    EXPECT_TRUE(endedBy(status, SIGINT)) << status;
    EXPECT_THAT(get("log"), HasSubstr("of 100000 frames are finished"));
    size_t frames = 0;
    for (const auto& entry : fs::directory_iterator(folder_)) {
        if (entry.path().extension() != ".png") continue;
        EXPECT_EQ(image::readPngOrJpeg(entry.path()).width, 32u) << entry.path();
        ++frames;
    }
    EXPECT_GE(frames, 4u);
}

TEST_F(CliMannersTest, PreviewsAreForStills) {
    expect("render builtin:cornell-moving --frames 2 --preview -o " + path("a.%d.png"), 2,
           "--preview is for stills");
    expect("render builtin:cornell --denoiser svgf --preview -o " + path("a.png"), 2,
           "--preview is for stills");
    fs::create_directory(path("a.preview.png"));
    expect("render builtin:cornell --spp 1 --width 16 --height 9 --device cpu --preview -o " + path("a.exr"),
           1, "a.preview.png: is a directory");
    EXPECT_FALSE(fs::exists(path("a.exr"))) << "found before the render, not three seconds into it";
}

}  // namespace
}  // namespace limpid
