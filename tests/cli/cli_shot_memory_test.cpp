// Tests that memory does not grow with the number of frames: compares the peaks of `limpid denoise` for a
// short shot and for a long one, whose frames are links to the same few files, and those of `limpid render`.
#include <fmt/format.h>

#include "tests/cli/cli_fixture.h"
#include "tests/cli/measured_run.h"

namespace limpid {
namespace {

/// The difference between two equal runs, caused by drivers and allocators. If each frame left one picture of
/// colours behind, the long shot would take 30 MB more.
constexpr uint64_t noise = uint64_t{16} << 20;
constexpr int few = 10, many = 100, rendered = 3;

class ShotMemoryTest : public CliTest {
  protected:
    void SetUp() override {
#if defined(__SANITIZE_ADDRESS__)
        GTEST_SKIP() << "sanitizers keep what is freed";
#endif
        CliTest::SetUp();
        const Result noisy =
            run("render builtin:cornell-moving --frames 3 --width 192 --height 108 --spp 1 --jitter off "
                "--aov all --float --device cpu -o " +
                path("own.%02d.exr"));
        ASSERT_EQ(noisy.code, 0) << noisy.output;
        for (int frame = 0; frame < many; ++frame)
            fs::create_hard_link(path(fmt::format("own.{:02}.exr", frame % rendered)),
                                 path(fmt::format("in.{:03}.exr", frame)));
    }

    /// Returns the peak, and deletes the outputs.
    uint64_t peakOf(int frames, const std::vector<std::string>& options) {
        std::vector<std::string> words = {LIMPID_PROGRAM,
                                          "denoise",
                                          path("in.%03d.exr"),
                                          "-o",
                                          path("out.%03d.exr"),
                                          "--device",
                                          "cpu",
                                          "--frames",
                                          fmt::format("0-{}", frames - 1)};
        words.insert(words.end(), options.begin(), options.end());
        const MeasuredRun measured = runMeasured(words, path("log.txt"));
        EXPECT_EQ(measured.code, 0) << measured.output;
        for (int frame = 0; frame < frames; ++frame)
            EXPECT_TRUE(fs::remove(path(fmt::format("out.{:03}.exr", frame)))) << frame;
        return measured.peak;
    }
};

TEST_F(ShotMemoryTest, OwnFilesTakeNoMoreInALongShot) {
    const uint64_t shortPeak = peakOf(few, {});
    EXPECT_LT(peakOf(many, {}), shortPeak + noise);
}

TEST_F(ShotMemoryTest, FilesOfOtherRenderersTakeNoMoreInALongShot) {
    // Assignments let Limpid's own files be read as those of other renderers are.
    const std::vector<std::string> options = {"--denoiser", "temporal", "--map", "roughness=roughness.R"};
    const uint64_t shortPeak = peakOf(few, options);
    EXPECT_LT(peakOf(many, options), shortPeak + noise);
}

/// Debian 12's lavapipe compiles some shaders for each dispatch, and keeps them, if it is let
/// (gpu/vulkan/execute/dynamic_params.h): 22 MB a frame here.
TEST_F(ShotMemoryTest, ALongClipTakesNoMoreThanAShortOne) {
    const auto peak = [&](int frames) {
        const MeasuredRun measured = runMeasured(
            {LIMPID_PROGRAM, "render", "builtin:cornell", "--denoiser", "nano", "--width", "120", "--height",
             "120", "--device", "cpu", "-o", path("clip.%03d.png"), "--frames", fmt::format("{}", frames)},
            path("log.txt"));
        EXPECT_EQ(measured.code, 0) << measured.output;
        return measured.peak;
    };
    const uint64_t shortPeak = peak(4);
    EXPECT_LT(peak(24), shortPeak + 4 * noise);
}

}  // namespace
}  // namespace limpid
