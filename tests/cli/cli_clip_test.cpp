// Tests `limpid render` to a clip with the program ffmpeg; skipped if it is not installed.
#include <sys/wait.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <thread>

#include "image/io/png/png.h"
#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

constexpr const char* scene = "render builtin:cornell-moving --width 33 --height 17 --spp 1 --device cpu ";

class CliClipTest : public CliTest {
  protected:
    void SetUp() override {
        CliTest::SetUp();
        if (std::system("ffmpeg -version >/dev/null 2>&1") == 0) return;
        std::cerr << "\n***** NOT TESTED: clips; the program ffmpeg is not installed *****\n\n";
        GTEST_SKIP();
    }
    /// Returns one line about the video: "width,height,frames".
    std::string probe(const std::string& name) const {
        return runProgram(
                   "ffprobe -v error -count_frames -select_streams v -show_entries "
                   "stream=width,height,nb_read_frames -of csv=p=0 'file:" +
                   path(name) + "'")
            .output;
    }
    size_t files() const {
        return static_cast<size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    /// Creates a program named ffmpeg that runs this script instead.
    std::string fakeFfmpeg(const std::string& script) const {
        fs::create_directories(folder_ / "bin");
        put("bin/ffmpeg", "#!/bin/sh\n" + script);
        fs::permissions(folder_ / "bin" / "ffmpeg", fs::perms::owner_all);
        return "PATH='" + path("bin") + "':/usr/bin:/bin '" + LIMPID_PROGRAM + "' ";
    }
    /// Starts a long clip, and returns when ffmpeg runs, as a temporary file shows.
    pid_t startClip(const std::string& program, size_t filesBefore) const {
        const std::string command =
            "exec env " + program + scene + "--frames 100000 -o " + path("a.mp4") + " >/dev/null 2>&1";
        const pid_t process = ::fork();
        if (process == 0) {
            ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
            std::_Exit(127);
        }
        EXPECT_GT(process, 0);
        for (int i = 0; i < 600 && files() == filesBefore; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        EXPECT_EQ(files(), filesBefore + 1);
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        return process;
    }
    static void expectEndBy(pid_t process, int signal) {
        int status = 0;
        ASSERT_EQ(::waitpid(process, &status, 0), process);
        EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
    }
    double meanOf(const std::string& name, size_t component) const {
        const image::ByteImage picture = image::readPngOrJpeg(path(name));
        double sum = 0.0;
        for (size_t i = component; i < picture.pixels.size(); i += 4) sum += picture.pixels[i];
        return sum / static_cast<double>(picture.pixels.size() / 4);
    }
};

TEST_F(CliClipTest, WritesEveryFormat) {
    for (const char* name : {"a.mp4", "a.webm", "a.gif", "a.webp"}) {
        const Result result = run(std::string(scene) + "--frames 3 --fps 10 -o " + path(name));
        ASSERT_EQ(result.code, 0) << name << "\n" << result.output;
    }
    EXPECT_EQ(probe("a.mp4"), "34,18,3\n") << "yuv420p wants even sizes";
    EXPECT_EQ(probe("a.webm"), "34,18,3\n");
    EXPECT_EQ(probe("a.gif"), "33,17,3\n");
    // Debian's ffprobe cannot decode animated WebP, so count its frames by their chunks.
    const std::string webp = get("a.webp");
    EXPECT_EQ(webp.substr(0, 4) + webp.substr(8, 4), "RIFFWEBP");
    size_t frames = 0;
    for (size_t at = webp.find("ANMF"); at != std::string::npos; at = webp.find("ANMF", at + 1)) ++frames;
    EXPECT_EQ(frames, 3u);
    EXPECT_EQ(files(), 4u) << "no temporary file stays";
}

TEST_F(CliClipTest, ColoursAreThoseOfThePictures) {
    // Even size and little noise, since halving the chroma of noisy pixels leaves the valid range and is
    // clamped.
    const std::string render =
        "render builtin:cornell-moving --width 64 --height 36 --spp 64 --device cpu --integrator path "
        "--frames 1 ";
    // From a distance, with a bright background, which automatic exposure ignores.
    for (const char* view :
         {"--exposure 1 ", "--exposure auto --background 90,90,90 --eye 0.3,0.3,4 --target 0.3,0.3,0 "}) {
        ASSERT_EQ(run(render + view + "-o " + path("a.mp4")).code, 0);
        ASSERT_EQ(run(render + view + "-o " + path("a.png")).code, 0);
        ASSERT_EQ(runProgram("ffmpeg -y -v error -i " + path("a.mp4") + " " + path("b.png")).code, 0);
        for (size_t component = 0; component < 3; ++component)
            EXPECT_NEAR(meanOf("b.png", component), meanOf("a.png", component), 1.5) << view << component;
    }
}

TEST_F(CliClipTest, NamesAreNeitherOptionsNorProtocols) {
    const std::string inFolder =
        "cd '" + folder_.string() + "' && '" + LIMPID_PROGRAM + "' " + scene + "--frames 2 ";
    for (const char* name : {"http:x.mp4", "a b;touch c.gif"})
        EXPECT_EQ(runProgram(inFolder + "-o '" + name + "'").code, 0) << name;
    EXPECT_EQ(runProgram(inFolder + "--output=-y.mp4").code, 0);
    for (const char* name : {"http:x.mp4", "a b;touch c.gif", "-y.mp4"})
        EXPECT_TRUE(fs::exists(folder_ / name)) << name;
    EXPECT_EQ(files(), 3u);
}

TEST_F(CliClipTest, RefusesWhatDoesNotFitAClip) {
    const std::string render = std::string(scene) + "-o ";
    expect(render + path("a.%04d.mp4"), 2, "one file");
    expect(render + path("a.mp4") + " --aov normal", 2, "--aov");
    expect(render + path("a.mp4") + " --checkpoint " + path("a.ck"), 2, "not for clips");
    expect(render + path("none/a.mp4"), 1, "does not exist");
}

TEST_F(CliClipTest, SaysWhichPackageIsMissing) {
    const Result result =
        runProgram("PATH=" + path("none") + " '" + LIMPID_PROGRAM + "' " + scene + "-o " + path("a.mp4"));
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.output.find("install the Debian package 'ffmpeg'"), std::string::npos) << result.output;
    EXPECT_EQ(files(), 0u);
}

TEST_F(CliClipTest, ReportsAFailureOfFfmpegAndKeepsTheOldClip) {
    put("a.mp4", "old");
    for (const char* script : {"cat >/dev/null; echo boom >&2; exit 3", "echo boom >&2; exit 3"}) {
        const Result result = runProgram(fakeFfmpeg(script) + scene + "--frames 3 -o " + path("a.mp4"));
        EXPECT_EQ(result.code, 1) << result.output;
        EXPECT_NE(result.output.find("ffmpeg failed with exit code 3"), std::string::npos) << result.output;
        EXPECT_NE(result.output.find("boom"), std::string::npos) << result.output;
        EXPECT_EQ(get("a.mp4"), "old");
        EXPECT_EQ(files(), 2u) << "the old clip and bin";
    }
}

TEST_F(CliClipTest, AnInterruptedRenderKeepsItsFrames) {
    const pid_t process = startClip("'" + std::string(LIMPID_PROGRAM) + "' ", 0);
    EXPECT_EQ(::kill(process, SIGINT), 0);
    expectEndBy(process, SIGINT);
    EXPECT_EQ(files(), 1u);
    EXPECT_EQ(probe("a.mp4").substr(0, 6), "34,18,");
}

/// ffmpeg makes a file of no frames, too, which would replace the old clip.
TEST_F(CliClipTest, InterruptedBeforeItsFirstFrameItKeepsTheOldClip) {
    put("a.gif", "old");
    const Result result = runProgram(std::string("timeout -s INT 2 '") + LIMPID_PROGRAM +
                                     "' render builtin:cornell-moving --width 33 --height 17 --spp 1000000 "
                                     "--frames 3 --device cpu -o " +
                                     path("a.gif"));
    EXPECT_EQ(result.code, 124) << result.output;
    EXPECT_NE(result.output.find("wrote nothing to " + path("a.gif")), std::string::npos) << result.output;
    EXPECT_EQ(get("a.gif"), "old");
    EXPECT_EQ(files(), 1u) << "no temporary file stays";
}

TEST_F(CliClipTest, AskedTwiceItEndsAtOnceAndLeavesNoFile) {
    // An encoder that is slow to finish, so that the second signal finds the render at work.
    const std::string slow =
        fakeFfmpeg("for file; do :; done; : >\"${file#file:}\"; cat >/dev/null; sleep 20");
    const pid_t process = startClip(slow, 1);
    EXPECT_EQ(::kill(process, SIGTERM), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(800));
    EXPECT_EQ(::kill(process, SIGTERM), 0);
    expectEndBy(process, SIGTERM);
    EXPECT_EQ(files(), 1u) << "only bin";
}

}  // namespace
}  // namespace limpid
