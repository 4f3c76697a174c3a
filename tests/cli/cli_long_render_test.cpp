// Tests renders that are killed, limited in time or divided into shards: they give the same bits as one
// undisturbed run.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>
#include <vector>

#include "image/io/exr/exr.h"
#include "image/io/png/png.h"
#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

constexpr const char* small = " --width 32 --height 18 --device cpu ";

class CliLongRenderTest : public CliTest {
  protected:
    void expectDone(const std::string& arguments) {
        const Result result = run(arguments);
        ASSERT_EQ(result.code, 0) << arguments << "\n" << result.output;
    }
    void expectSame(const std::string& a, const std::string& b) const {
        const std::string bytes = get(a);
        EXPECT_FALSE(bytes.empty()) << a;
        EXPECT_TRUE(bytes == get(b)) << a << " and " << b << " differ";
    }
    std::string frame(const char* pattern, int number) const {
        return fmt::format(fmt::runtime(pattern), number);
    }
    size_t hiddenFiles() const {
        size_t count = 0;
        for (const auto& entry : fs::directory_iterator(folder_))
            count += entry.path().filename().string().starts_with(".");
        return count;
    }

    /// Starts the program and kills it after `milliseconds`; returns false if it ended before.
    static bool startAndKill(const std::vector<std::string>& arguments, int milliseconds) {
        std::vector<char*> argv{const_cast<char*>(LIMPID_PROGRAM)};
        for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        const pid_t child = ::fork();
        if (child == 0) {
            const int null = ::open("/dev/null", O_WRONLY);
            ::dup2(null, STDOUT_FILENO);
            ::dup2(null, STDERR_FILENO);
            ::execv(LIMPID_PROGRAM, argv.data());
            ::_exit(127);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        ::kill(child, SIGKILL);
        int status = 0;
        ::waitpid(child, &status, 0);
        EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0) << "exit code " << WEXITSTATUS(status);
        return WIFSIGNALED(status);
    }

    /// Kills the render ten times at random times, resuming each time, then lets the last run finish.
    static void killTenTimes(const std::vector<std::string>& arguments) {
        const char* given = std::getenv("LIMPID_TEST_SEED");
        const auto seed =
            given ? static_cast<unsigned>(std::strtoul(given, nullptr, 10)) : std::random_device()();
        fmt::print("LIMPID_TEST_SEED={}\n", seed);
        std::mt19937 random(seed);
        std::uniform_int_distribution<int> milliseconds(20, 700);
        int killed = 0;
        std::string moments;
        for (int i = 0; i < 10; ++i) {
            const int after = milliseconds(random);
            moments += fmt::format(" {}", after);
            killed += startAndKill(arguments, after);
        }
        fmt::print("killed {} times, after ms:{}\n", killed, moments);
        EXPECT_GE(killed, 3) << "the render is too short for this machine";
        std::string line;
        for (const std::string& argument : arguments) line += " '" + argument + "'";
        const Result last = run(line);
        EXPECT_EQ(last.code, 0) << last.output;
    }
};

TEST_F(CliLongRenderTest, AStillKilledTenTimesIsTheSame) {
    const std::string scene = "render builtin:cornell --samples-per-launch 4 --spp 960 --aov all";
    expectDone(scene + small + "-o " + path("whole.exr"));
    killTenTimes({"render", "builtin:cornell", "--samples-per-launch", "4", "--spp", "960", "--aov", "all",
                  "--width", "32", "--height", "18", "--device", "cpu", "-o", path("killed.exr"),
                  "--checkpoint", path("still.ck"), "--resume"});
    expectSame("whole.exr", "killed.exr");
    EXPECT_EQ(hiddenFiles(), 0u) << "temporary files of killed runs";
}

TEST_F(CliLongRenderTest, ASequenceKilledTenTimesIsTheSame) {
    constexpr int frames = 16;
    const std::string scene =
        "render builtin:cornell-moving --frames 16 --samples-per-launch 4 --spp 80 --aov all";
    expectDone(scene + small + "-o " + path("whole.%04d.exr"));
    killTenTimes({"render",
                  "builtin:cornell-moving",
                  "--frames",
                  "16",
                  "--samples-per-launch",
                  "4",
                  "--spp",
                  "80",
                  "--aov",
                  "all",
                  "--width",
                  "32",
                  "--height",
                  "18",
                  "--device",
                  "cpu",
                  "-o",
                  path("killed.%04d.exr"),
                  "--checkpoint",
                  path("sequence.ck"),
                  "--resume"});
    for (int i = 0; i < frames; ++i) expectSame(frame("whole.{:04}.exr", i), frame("killed.{:04}.exr", i));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()),
              2 * frames + 1 + static_cast<int>(hiddenFiles()));
}

TEST_F(CliLongRenderTest, MergedSamplesAreThoseOfOneRun) {
    const std::string scene =
        "render builtin:cornell-spheres --spp 200 --seed 4 --aov all" + std::string(small);
    expectDone(scene + "-o " + path("whole.exr"));
    std::string files;
    for (const char* shard : {"3", "1", "5", "2", "4"}) {  // four blocks: the fifth shard has none
        const std::string file = path(fmt::format("{}.sums", shard));
        expectDone(scene + fmt::format("--shard {}/5 -o {}", shard, file));
        files += " " + file;
    }
    expectDone("merge" + files + " -o " + path("merged.exr"));
    expectSame("whole.exr", "merged.exr");
}

/// Each block finds its own instants of the open shutter.
TEST_F(CliLongRenderTest, MotionBlurIsTheSameInShards) {
    const std::string scene =
        "render builtin:cornell-moving --time 0.5 --fps 4 --spp 130" + std::string(small);
    const std::string blurred = scene + "--shutter 1 ";
    expectDone(blurred + "-o " + path("whole.exr"));
    for (const char* shard : {"2", "1"})
        expectDone(blurred + fmt::format("--shard {}/2 -o {}", shard, path(fmt::format("{}.sums", shard))));
    expectDone("merge " + path("1.sums") + " " + path("2.sums") + " -o " + path("merged.exr"));
    expectSame("whole.exr", "merged.exr");
    expectDone(scene + "-o " + path("sharp.exr"));
    EXPECT_NE(get("whole.exr"), get("sharp.exr"));

    const std::string checkpoint = "--checkpoint " + path("a.ck") + " -o " + path("a.exr");
    expectDone(blurred + checkpoint);
    expect(scene + "--shutter 0.5 --resume " + checkpoint, 3, "shutter is 1 frames, center, not 0.5 frames");
    expect(scene + "--shutter 1 --denoiser svgf -o " + path("b.exr"), 2, "--shutter");
    expect(scene + "--shutter 1 --progressive -o " + path("b.exr"), 2, "--shutter");
    expect(scene + "--shutter-position end -o " + path("b.exr"), 2, "goes with --shutter");
    expect("render builtin:cornell --spp 1 --shutter 1 -o " + path("b.exr") + small, 0, "nothing moves");
    expect("render builtin:cornell-moving --spp 32 --samples-per-launch 4 --shutter 1 -o " + path("b.exr") +
               small,
           0, "there are 8 launches");
}

/// tools/slurm/shard.sh, with the variables that Slurm sets.
TEST_F(CliLongRenderTest, TasksOfAJobArrayAreShards) {
    const auto task = [](const std::string& id, const std::string& range, const std::string& arguments) {
        return runProgram(fmt::format("SLURM_ARRAY_TASK_ID={} {} LIMPID='{}' '{}/tools/slurm/shard.sh' {}",
                                      id, range, LIMPID_PROGRAM, LIMPID_SOURCE_DIR, arguments));
    };
    const std::string all = "SLURM_ARRAY_TASK_MIN=1 SLURM_ARRAY_TASK_MAX=2 SLURM_ARRAY_TASK_COUNT=2";
    const std::string some = "SLURM_ARRAY_TASK_MIN=2 SLURM_ARRAY_TASK_MAX=2 SLURM_ARRAY_TASK_COUNT=1";
    const std::string scene = "render builtin:cornell --spp 128" + std::string(small);
    const std::string parts =
        scene + "-o " + path("{shard}.sums") + " --checkpoint " + path("{shard}.ck") + " --resume";
    expectDone(scene + "-o " + path("whole.exr"));
    EXPECT_EQ(task("1", all, parts).code, 0);
    expect("merge " + path("1.sums") + " -o " + path("merged.exr"), 3, "shard 2 of 2");
    Result result = task("2", some, parts);
    EXPECT_EQ(result.code, 2);
    EXPECT_NE(result.output.find("LIMPID_SHARDS"), std::string::npos) << result.output;
    EXPECT_EQ(task("2", some + " LIMPID_SHARDS=2", parts).code, 0);
    expectDone("merge " + path("1.sums") + " " + path("2.sums") + " -o " + path("merged.exr"));
    expectSame("whole.exr", "merged.exr");
    EXPECT_EQ(task("", "", parts).code, 2);
}

TEST_F(CliLongRenderTest, MergedPngsAndFloatsAreThoseOfOneRun) {
    const std::string scene = "render builtin:cornell --spp 70 --exposure 0.5" + std::string(small);
    expectDone(scene + "-o " + path("whole.png"));
    for (const char* shard : {"1", "2"})
        expectDone(scene + fmt::format("--shard {0}/2 -o {1}/{0}.sums", shard, folder_.string()));
    expectDone("merge " + path("1.sums") + " " + path("2.sums") + " -o " + path("merged.png"));
    expectSame("whole.png", "merged.png");
    // With a jitter that the file tells.
    const std::string floats = scene + "--float --jitter frame ";
    expectDone(floats + "-o " + path("whole.exr"));
    EXPECT_TRUE(image::readExr(path("whole.exr")).metadata.contains("limpid.jitter"));
    for (const char* shard : {"1", "2"})
        expectDone(floats + fmt::format("--shard {0}/2 -o {1}/{0}.sums", shard, folder_.string()));
    expectDone("merge " + path("1.sums") + " " + path("2.sums") + " -o " + path("merged.exr"));
    expectSame("whole.exr", "merged.exr");
}

TEST_F(CliLongRenderTest, FramesOfShardsAreThoseOfOneRun) {
    const std::string scene =
        "render builtin:cornell-moving --frames 5 --fps 8 --camera-path orbit --spp 2 --aov all" +
        std::string(small);
    fs::create_directories(folder_ / "a");
    fs::create_directories(folder_ / "b");
    fs::create_directories(folder_ / "all");
    expectDone(scene + "-o " + path("%d.exr"));
    expectDone(scene + "--shard 1/2 -o " + path("a/%d.exr"));
    expectDone(scene + "--shard 2/2 -o " + path("b/%d.exr"));
    for (int i = 0; i < 5; ++i)
        expectSame(frame("{}.exr", i), frame(i % 2 == 0 ? "a/{}.exr" : "b/{}.exr", i));
    const std::string a = path("a/%d.exr "), b = path("b/%d.exr "), to = "-o " + path("all/%d.exr");
    expectDone("merge " + b + a + to);
    for (int i = 0; i < 5; ++i) expectSame(frame("{}.exr", i), frame("all/{}.exr", i));

    expect("merge " + b + to, 3, "lacks frame 0, 2, 4 of 0-4");
    expect("merge " + a + b + a + to, 3, "which is");
    expect("merge " + path("none.%d.exr ") + to, 3, "no such frames");
    expectDone(scene + "--seed 1 --shard 2/2 -o " + path("b/%d.exr"));
    expect("merge " + a + b + to, 3, "another render");
    fs::rename(folder_ / "a/2.exr", folder_ / "a/1.exr");
    expect("merge " + a + to, 3, "by its name");
    put("a/1.exr", "broken");
    expect("merge " + a + to, 3, "a/1.exr");
}

TEST_F(CliLongRenderTest, TimeLimitsAreKeptAndGoneOnFrom) {
    const std::string scene = "render builtin:cornell --spp 640 --json" + std::string(small);
    expectDone(scene + "-o " + path("whole.exr"));
    const std::string limited = scene + "--checkpoint " + path("a.ck") + " --resume -o " + path("a.exr");
    // Only the one launch that a picture needs fits into this time.
    const Result first = run(limited + " --time-limit 0.001");
    ASSERT_EQ(first.code, 0) << first.output;
    EXPECT_NE(first.output.find("\"samples\": 1,"), std::string::npos) << first.output;
    EXPECT_NE(first.output.find("\"complete\": false"), std::string::npos) << first.output;
    EXPECT_NE(first.output.find("1 of 640 samples"), std::string::npos) << first.output;
    EXPECT_NE(first.output.find("not one block of 64"), std::string::npos) << first.output;
    EXPECT_EQ(image::readExr(path("a.exr")).metadata.at("limpid.samples"), "1");
    const Result second = run(limited + " --time-limit 1.5");
    EXPECT_EQ(second.code, 0) << second.output;
    const Result endless = run("render builtin:cornell --spp 16777216 --json" + std::string(small) +
                               "--checkpoint " + path("b.ck") + " --time-limit 1 -o " + path("b.exr"));
    EXPECT_EQ(endless.code, 0) << endless.output;
    EXPECT_NE(endless.output.find("\"complete\": false"), std::string::npos) << endless.output;
    expectDone(limited);
    expectSame("whole.exr", "a.exr");
    const Result again = run(limited);
    EXPECT_NE(again.output.find("\"rays\": 0"), std::string::npos) << "it was finished: " << again.output;
    expectSame("whole.exr", "a.exr");
}

TEST_F(CliLongRenderTest, ASequenceOutOfTimeHasWholeFramesOnly) {
    const std::string scene =
        "render builtin:cornell-moving --frames 3 --spp 4 --checkpoint " + path("s.ck") + " --resume" + small;
    const Result first = run(scene + "--time-limit 0.001 -o " + path("%d.exr"));
    EXPECT_EQ(first.code, 0) << first.output;
    EXPECT_NE(first.output.find("0 of 3 frames"), std::string::npos) << first.output;
    EXPECT_FALSE(fs::exists(path("0.exr")));
    expectDone(scene + "-o " + path("%d.exr"));
    const std::string bytes = get("1.exr");
    fs::remove(path("1.exr"));
    put("2.exr", "not touched");
    expectDone(scene + "-o " + path("%d.exr"));
    EXPECT_TRUE(get("1.exr") == bytes) << "a frame that was removed is rendered again";
    EXPECT_EQ(get("2.exr"), "not touched");
}

/// With a limit that a PNG keeps and a checkpoint does not, whose header has the scene's long name.
TEST_F(CliLongRenderTest, ACheckpointThatCannotBeWrittenDoesNotLoseThePicture) {
    const std::string scene(200, 'a');
    put(scene + ".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto onAFullDisk = [&](const std::string& more, const std::string& output) {
        // Ignores SIGXFSZ, so that the write fails as on a full disk.
        return runProgram(
            fmt::format("bash -c 'trap \"\" XFSZ; ulimit -f 1; exec \"{}\" render {} --width 8 "
                        "--height 8 --device cpu {} --checkpoint {} -o {}'",
                        LIMPID_PROGRAM, path(scene + ".obj"), more, path("a.ck"), output));
    };
    const std::string fault = "a.ck: cannot be written", earlier = "goes on from an earlier state";
    const std::string begun = "--spp 130 --time-limit 0.001";
    const Result part = onAFullDisk(begun, path("part.png"));
    EXPECT_EQ(part.code, 1) << part.output;
    EXPECT_THAT(part.output, testing::HasSubstr(fault));
    EXPECT_THAT(part.output, testing::HasSubstr("the work since the one before is lost"));
    EXPECT_THAT(part.output, testing::Not(testing::HasSubstr("--resume")))
        << "there is nothing to go on from";
    EXPECT_EQ(image::readPngOrJpeg(path("part.png")).width, 8u);
    EXPECT_FALSE(fs::exists(path("a.ck")));
    expect("render " + path(scene + ".obj") + " --width 8 --height 8 --device cpu " + begun +
               " --checkpoint " + path("a.ck") + " -o " + path("part.png"),
           0, "--resume makes the rest");
    const std::string kept = get("a.ck");
    // Of the blocks, only the first is followed by an attempt: the next one is due after 20 s.
    const Result whole = onAFullDisk("--spp 130 --resume", path("whole.png"));
    EXPECT_EQ(whole.code, 0) << whole.output;
    EXPECT_THAT(whole.output, testing::HasSubstr(fault));
    EXPECT_THAT(whole.output, testing::HasSubstr(earlier)) << "of the last attempt";
    EXPECT_THAT(whole.output, testing::HasSubstr(": 130 samples"));
    EXPECT_EQ(image::readPngOrJpeg(path("whole.png")).width, 8u);
    EXPECT_EQ(get("a.ck"), kept);
}

TEST_F(CliLongRenderTest, ACheckpointThatDoesNotFitIsRefused) {
    const std::string ck = "--checkpoint " + path("a.ck") + " -o " + path("a.exr");
    const std::string scene = "render builtin:cornell --spp 64 " + ck + small;
    expectDone(scene);
    const std::string whole = get("a.ck");
    fs::remove(path("a.exr"));
    expect(scene, 2, "--resume");
    expect(scene + "--resume --seed 7", 3, "seed is 0, not 7");
    expect(scene + "--resume --max-depth 3", 3, "pathtrace.max_depth is 8, not 3");
    expect(scene + "--resume --jitter off", 3, "jitter is pixel, not off");
    expect(scene + "--resume --aov depth", 3, "layers");
    expect("render builtin:cornell-spheres --spp 64 --resume " + ck + small, 3, "scene");
    expect("render builtin:cornell --spp 64 --resume --width 16 --height 18 --device cpu " + ck, 3,
           "width is 32, not 16");
    expect("render builtin:cornell --spp 64 --resume --shard 1/2 --checkpoint " + path("a.ck") + " -o " +
               path("a.sums") + small,
           3, "shard 1/1, not 1/2");
    put("a.ck", whole.substr(0, whole.size() / 2));
    expect(scene + "--resume", 3, "a.ck: ");
    put("a.ck", "");
    expect(scene + "--resume", 3, "a.ck: ");
    std::string damaged = whole;
    damaged[whole.size() / 2] ^= 1;
    put("a.ck", damaged);
    expect(scene + "--resume", 3, "checksum");
    EXPECT_EQ(get("a.ck"), damaged) << "a refused checkpoint is left alone";
    EXPECT_FALSE(fs::exists(path("a.exr")));
}

/// The finished frames keep their look; a still gets the new one.
TEST_F(CliLongRenderTest, FramesOfOneSequenceLookAlike) {
    const auto with = [&](const char* ck) { return "--spp 1 --resume --checkpoint " + path(ck) + small; };
    const std::string moving = "render builtin:cornell-moving --frames 2 -o ";
    const std::string sequence = moving + path("%d.png ") + with("s.ck");
    expectDone(sequence);
    expect(sequence + "--exposure 1", 3, "look different: --exposure is auto, not 1");
    expect(sequence + "--tone-curve agx", 3, "--tone-curve is standard, not agx");
    expect(moving + path("%d.exr ") + with("s.ck") + "--float", 3, "--float is false, not true");
    expectDone(sequence);
    const std::string still = "render builtin:cornell -o " + path("a.png ") + with("a.ck");
    expectDone(still);
    const std::string before = get("a.png");
    expectDone(still + "--exposure 5");
    EXPECT_NE(get("a.png"), before);
}

/// An open shutter sees the camera between the frames' times, too.
TEST_F(CliLongRenderTest, ABlurredRenderIsOfItsWholeCameraPath) {
    const auto drive = [&](const char* to) {
        put("path.json", fmt::format(R"({{"keys": [{{"time": 0, "eye": [0, 1, 3], "target": [0, 1, 0]}},
            {{"time": 1, "eye": [0, 1, {}], "target": [0, 1, 0]}}]}})",
                                     to));
    };
    const std::string scene = "render builtin:cornell --spp 16 --fps 1 --camera-path " + path("path.json") +
                              " --resume --checkpoint " + path("a.ck") + " -o " + path("a.exr") + small;
    drive("2");
    expectDone(scene + "--shutter 1");
    expectDone(scene + "--shutter 1");
    drive("1.5");
    expect(scene + "--shutter 1", 3, "another render: the camera");
}

/// Each frame has its own rays only, so a late one blurs a fine texture as much as the first.
TEST_F(CliLongRenderTest, FramesWithAJitterFilterTexturesAlike) {
    image::ByteImage noise{256, 256, 3, {}};
    std::mt19937 random(1);
    for (size_t p = 0; p < size_t{256} * 256; ++p)
        noise.pixels.insert(noise.pixels.end(), 3, static_cast<uint8_t>(random() % 2 * 255));
    image::writePng(folder_ / "noise.png", noise);
    put("a.mtl", "newmtl m\nKd 0 0 0\nKe 1 1 1\nmap_Ke noise.png\n");
    put("a.obj",
        "mtllib a.mtl\nusemtl m\nv -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nvt 0 0\nvt 16 0\nvt 16 16\nvt 0 16\n"
        "f 1/1 2/2 3/3 4/4\n");
    const auto contrastOf = [&](int frame) {
        expectDone(
            "render " + path("a.obj") + small + "--eye 0,0,8 --target 0,0,0 --background 0,0,0 " +
            fmt::format("--max-depth 0 --jitter frame --spp 1 --frames 1000 --shard {}/1000 -o ", frame + 1) +
            path("%d.png") + " --exposure 0 --tone-curve none");
        const image::ByteImage picture = image::readPngOrJpeg(path(fmt::format("{}.png", frame)));
        double sum = 0.0, squares = 0.0, count = 0.0;
        for (size_t i = 0; i < picture.pixels.size(); i += picture.components, ++count) {
            const double value = picture.pixels[i];
            sum += value;
            squares += value * value;
        }
        EXPECT_GT(sum / count, 100.0) << "the texture fills the picture";
        return std::sqrt(squares / count - sum * sum / (count * count));
    };
    EXPECT_LT(contrastOf(0), 4.0);
    EXPECT_LT(contrastOf(999), 4.0) << "16 if the rays of all frames are counted";
}

TEST_F(CliLongRenderTest, EmptyShardsSaySo) {
    const std::string rest = " --spp 1 --shard 3/3" + std::string(small);
    expect("render builtin:cornell -o " + path("a.sums") + rest, 0, "shard 3/3 is empty");
    EXPECT_TRUE(fs::exists(path("a.sums"))) << "or a script that expects it fails";
    expect("render builtin:cornell-moving --frames 2 -o " + path("%d.exr") + rest, 0, "shard 3/3 is empty");
    expect("render builtin:cornell-moving --frames 1 -o " + path("%d.exr") + rest, 2, "a still");
}

TEST_F(CliLongRenderTest, TheSceneFilesContentCounts) {
    const auto triangle = [&](const char* height) {
        put("a.obj", fmt::format("v 0 0 0\nv 1 0 0\nv 0 {} 0\nf 1 2 3\n", height));
    };
    const std::string scene = "render " + path("a.obj") + " --spp 1 --checkpoint " + path("a.ck") +
                              " --resume -o " + path("a.exr") + small;
    triangle("1");
    expectDone(scene);
    triangle("1.5");
    expect(scene, 3, "another render: the scene's content");
}

TEST_F(CliLongRenderTest, WrongUsageIsExitCode2) {
    const std::string scene = "render builtin:cornell --spp 1" + std::string(small);
    expect(scene + "--resume -o " + path("a.exr"), 2, "--checkpoint");
    expect(scene + "--time-limit 0 -o " + path("a.exr"), 2, "--time-limit");
    for (const char* shard : {"0/2", "3/2", "1/0", "1", "/", "a/b", "1/2/3", "-1/2", "1/2x"})
        expect(scene + "--shard " + shard + " -o " + path("a.sums"), 2, "--shard");
    expect(scene + "--shard 1/2 -o " + path("a.exr"), 2, ".sums");
    expect(scene + "-o " + path("a.sums"), 2, "only a shard");
    expect("merge -o " + path("a.exr"), 2, "FILE");
    expect("merge " + path("a.sums") + " -o " + path("a.jpg"), 2, ".exr or .png");
    expect("merge " + path("%d.exr") + " -o " + path("b.%d.png"), 2, ".exr");
    expect("merge " + path("a.exr") + " -o " + path("b.%d.exr"), 2, "holds a number");
    expect("merge " + path("a.sums") + " -o " + path("a.exr"), 3, "a.sums");
    expect(scene + "--checkpoint " + path("no/such.ck") + " -o " + path("a.exr"), 1, "does not exist");
}

}  // namespace
}  // namespace limpid
