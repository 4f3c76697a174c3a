// Tests commands that several processes share (mpirun): the bits of one process, whatever happens to the
// others.
#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>
#include <thread>
#include <vector>

#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

using std::chrono::milliseconds;

/// For Open MPI: allowed for root, more processes than cores, none bound to a core; and within containers,
/// where processes may not read each other's memory.
constexpr const char* manners =
    "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 "
    "OMPI_MCA_hwloc_base_binding_policy=none OMPI_MCA_btl_vader_single_copy_mechanism=none";

/// A still of three blocks, the last one of 8 samples.
constexpr const char* still =
    "render builtin:cornell --spp 136 --aov all --width 32 --height 18 --device cpu ";
constexpr const char* longStill =
    "render builtin:cornell --spp 760 --aov all --width 32 --height 18 --device cpu ";

class CliClusterTest : public CliTest {
  protected:
    void SetUp() override {
        CliTest::SetUp();
        if (!fs::exists(LIMPID_MPI_MODULE)) GTEST_SKIP() << "SKIPPED: no MPI, so no limpid_mpi.so";
        if (!fs::exists(LIMPID_MPIRUN)) GTEST_SKIP() << "SKIPPED: no mpirun";
    }
    /// A command for sh, which it becomes.
    static std::string mpirun(int processes, const std::string& arguments,
                              const std::string& variables = "") {
        return fmt::format("exec env {} {} timeout 120 '{}' -n {} '{}' {}", manners, variables, LIMPID_MPIRUN,
                           processes, LIMPID_PROGRAM, arguments);
    }
    static Result runTogether(int processes, const std::string& arguments,
                              const std::string& variables = "") {
        return runProgram(mpirun(processes, arguments, variables));
    }
    static void expectDone(const Result& result) { ASSERT_EQ(result.code, 0) << result.output; }
    void expectSame(const std::string& a, const std::string& b) const {
        const std::string bytes = get(a);
        EXPECT_FALSE(bytes.empty()) << a;
        EXPECT_TRUE(bytes == get(b)) << a << " and " << b << " differ";
    }
    void expectSameFiles(const std::string& a, const std::string& b, size_t count) const {
        size_t found = 0;
        for (const auto& entry : fs::directory_iterator(folder_ / a)) {
            const std::string name = entry.path().filename();
            expectSame(a + "/" + name, b + "/" + name);
            ++found;
        }
        EXPECT_EQ(found, count) << a;
        EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / b), {}), static_cast<ptrdiff_t>(count)) << b;
    }
    void makeFolders(const std::vector<std::string>& names) const {
        for (const std::string& name : names) fs::create_directories(folder_ / name);
    }
    static size_t countOf(const std::string& part, const std::string& text) {
        size_t count = 0;
        for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
        return count;
    }
    static std::vector<int> piecesIn(const Result& result) {
        const size_t at = result.output.find('{');
        const auto report =
            nlohmann::json::parse(result.output.substr(std::min(at, result.output.size())), nullptr, false);
        if (!report.contains("pieces_by_process")) {
            ADD_FAILURE() << result.output;
            return {};
        }
        return report["pieces_by_process"].get<std::vector<int>>();
    }

    /// Starts mpirun, waits until `file` is there, sends a signal to one of its processes, and waits for the
    /// end of all.
    Result signalOne(int rank, int signal, const std::string& file, const std::string& command) const {
        const fs::path output = folder_ / "output.txt";
        const pid_t child = ::fork();
        if (child == 0) {
            const int out = ::open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
            ::dup2(out, STDOUT_FILENO);
            ::dup2(out, STDERR_FILENO);
            ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
            ::_exit(127);
        }
        for (int i = 0; i < 2000 && !fs::exists(folder_ / file); ++i)
            std::this_thread::sleep_for(milliseconds(5));
        // sh has become env, and that timeout, whose child is mpirun.
        const std::vector<pid_t> launcher = childrenOf(child);
        const std::vector<pid_t> processes = launcher.empty() ? launcher : childrenOf(launcher[0]);
        if (processes.size() > static_cast<size_t>(rank))
            ::kill(processes[static_cast<size_t>(rank)], signal);
        else
            ADD_FAILURE() << "the processes of mpirun were not found";
        int status = 0;
        ::waitpid(child, &status, 0);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, get("output.txt")};
    }
    static std::vector<pid_t> childrenOf(pid_t parent) {
        std::vector<pid_t> children;
        for (const auto& task : fs::directory_iterator(fmt::format("/proc/{}/task", parent))) {
            std::ifstream stream(task.path() / "children");
            for (pid_t child = 0; stream >> child;) children.push_back(child);
        }
        std::sort(children.begin(), children.end());
        return children;
    }
};

TEST_F(CliClusterTest, AStillIsThatOfOneProcess) {
    expectDone(run(still + ("-o " + path("one.exr") + " --checkpoint " + path("one.ck"))));
    for (const int processes : {1, 2, 4}) {
        const std::string name = std::to_string(processes);
        const Result result = runTogether(
            processes, still + ("-o " + path(name + ".exr") + " --checkpoint " + path(name + ".ck")));
        expectDone(result);
        EXPECT_EQ(countOf("info: wrote", result.output), 1u) << "process 0 reports: " << result.output;
        expectSame("one.exr", name + ".exr");
        expectSame("one.ck", name + ".ck");
    }
    const Result alone = runTogether(2, still + ("-o " + path("own.exr")), "LIMPID_MPI=0");
    EXPECT_EQ(countOf("info: wrote", alone.output), 2u) << alone.output;
}

TEST_F(CliClusterTest, FramesAreThoseOfOneProcess) {
    const std::string sequence =
        "render builtin:cornell-moving --frames 6 --fps 8 --spp 70 --width 32 --height 18 --device cpu ";
    makeFolders({"one", "two", "four"});
    expectDone(run(sequence + "-o " + path("one/%d.exr")));
    const std::string two = sequence + "-o " + path("two/%d.exr") + " --checkpoint " + path("two.ck");
    expectDone(runTogether(2, two));
    expectDone(runTogether(4, sequence + "-o " + path("four/%d.exr")));
    expectSameFiles("one", "two", 6);
    expectSameFiles("one", "four", 6);
    // What is lost is made again, by one process or by several.
    put("two/3.exr", "not touched");
    for (const bool together : {false, true}) {
        fs::remove(path("two/1.exr"));
        expectDone(together ? runTogether(2, two + " --resume") : run(two + " --resume"));
        expectSame("one/1.exr", "two/1.exr");
        EXPECT_EQ(get("two/3.exr"), "not touched");
    }
}

TEST_F(CliClusterTest, AShotIsThatOfOneProcess) {
    makeFolders({"noisy", "one", "two", "three", "shard"});
    expectDone(
        run("render builtin:cornell-moving --frames 20 --spp 1 --aov all --width 32 --height 18 --device cpu "
            "-o " +
            path("noisy/%02d.exr")));
    const std::string shot = "denoise --device cpu " + path("noisy/%02d.exr") + " -o ";
    expectDone(run(shot + path("one/%02d.exr --window 5")));
    expectDone(runTogether(2, shot + path("two/%02d.exr --window 5")));
    expectDone(runTogether(3, shot + path("three/%02d.exr --window 5 --json")));
    expectSameFiles("one", "two", 20);
    expectSameFiles("one", "three", 20);
    for (const char* part : {"1/4", "2/4", "3/4", "4/4"})
        expectDone(run(shot + path("shard/%02d.exr --shard ") + part));
    expectSameFiles("one", "shard", 20);
    fs::remove(path("two/07.exr"));
    const Result resumed = runTogether(2, shot + path("two/%02d.exr --window 5 --resume"));
    expectDone(resumed);
    EXPECT_NE(resumed.output.find("17 frames were complete"), std::string::npos) << resumed.output;
    expectSameFiles("one", "two", 20);
}

TEST_F(CliClusterTest, ADatasetIsThatOfOneProcess) {
    const std::string dataset =
        "dataset --device cpu --rooms 3 --width 16 --height 12 --samples 1,2 --reference-samples 4 "
        "--per-file 1 -o ";
    expectDone(run(dataset + path("one")));
    const Result result = runTogether(2, dataset + path("two"));
    expectDone(result);
    EXPECT_EQ(countOf("their manifest", result.output), 1u) << result.output;
    expectSameFiles("one", "two", 4);
}

/// Without times, which differ, and what names the files.
nlohmann::json withoutTimes(nlohmann::json report) {
    report.erase("command");
    report.erase("ranking");  // has mean times
    for (nlohmann::json& scene : report["scenes"]) {
        for (nlohmann::json& method : scene["methods"]) {
            for (const char* name : {"median_ms", "denoising_ms"}) method.erase(name);
            for (nlohmann::json& frame : method["frames"]) frame.erase("denoising_ms");
        }
    }
    return report;
}

/// The PNGs of a report, in Base64. The rest of its data has times.
std::vector<std::string> picturesIn(const std::string& page) {
    std::vector<std::string> pictures;
    for (size_t at = page.find("iVBORw0KGgo"); at != std::string::npos; at = page.find("iVBORw0KGgo", at + 1))
        pictures.push_back(page.substr(at, page.find('"', at) - at));
    return pictures;
}

TEST_F(CliClusterTest, QualityIsThatOfOneProcess) {
    put("bad.gltf", "no JSON");
    fs::create_directories(folder_ / "scenes/bad");
    fs::rename(path("bad.gltf"), path("scenes/bad/bad.gltf"));
    const auto quality = [&](const std::string& name) {
        return "bench quality --device cpu --width 32 --height 18 --first 1 --frames 3 --reference-spp 16 "
               "--denoiser temporal --scene builtin:cornell --scene builtin:cornell-moving "
               "--scene builtin:lab-lights --scenes-folder " +
               path("scenes") + " --json --out " + path(name) + " --report " + path(name + ".html") + " > " +
               path(name + ".json") + " 2> " + path(name + ".log") + " #";  // not both into one pipe
    };
    const auto reportIn = [&](const std::string& name) {
        return nlohmann::json::parse(get(name + ".json"), nullptr, false);
    };
    // Process 0 is slow at its first sequence, so that later ones arrive before it.
    const Result one = run(quality("one")),
                 two = runTogether(2, quality("two"), "LIMPID_TEST_SLOW_RANK=0:2000");
    expectDone(one);
    expectDone(two);
    EXPECT_EQ(countOf("SKIPPED: bad: ", get("two.log")), 1u) << get("two.log");
    EXPECT_EQ(countOf("2 processes made ", get("two.log")), 1u) << get("two.log");
    EXPECT_EQ(countOf("made 4, 0 ", get("two.log")) + countOf("made 0, 4 ", get("two.log")), 0u)
        << get("two.log");
    const nlohmann::json report = reportIn("one");
    ASSERT_EQ(report["scenes"].size(), 3u) << report;
    EXPECT_EQ(withoutTimes(report), withoutTimes(reportIn("two")));
    expectSameFiles("one", "two", 3);
    EXPECT_GT(picturesIn(get("one.html")).size(), 10u);
    EXPECT_EQ(picturesIn(get("one.html")), picturesIn(get("two.html")));
}

TEST_F(CliClusterTest, AKilledRunGoesOnFromItsCheckpoint) {
    expectDone(run(longStill + ("-o " + path("one.exr"))));
    const std::string resumable =
        longStill + ("-o " + path("killed.exr") + " --checkpoint " + path("killed.ck") + " --resume");
    for (const int killed : {1, 0}) {
        const Result result =
            signalOne(killed, SIGKILL, "killed.ck", mpirun(3, resumable, "LIMPID_TEST_SLOW_RANK=-1:120"));
        EXPECT_NE(result.code, 0) << result.output;
        EXPECT_FALSE(fs::exists(path("killed.exr"))) << result.output;
        fs::rename(path("killed.ck"), path(fmt::format("{}.ck", killed)));
    }
    fs::rename(path("1.ck"), path("killed.ck"));
    const Result resumed = runTogether(2, resumable + " --json");
    expectDone(resumed);
    const std::vector<int> pieces = piecesIn(resumed);
    const int made = std::accumulate(pieces.begin(), pieces.end(), 0);
    EXPECT_LT(made, 12) << "blocks of the checkpoint are not rendered again";
    EXPECT_GT(made, 0);
    expectSame("one.exr", "killed.exr");
    fs::rename(path("0.ck"), path("killed.ck"));
    expectDone(run(resumable));
    expectSame("one.exr", "killed.exr");
}

TEST_F(CliClusterTest, AProcessThatHangsLosesItsPiecesOnly) {
    expectDone(run(longStill + ("-o " + path("one.exr"))));
    const std::string command =
        mpirun(3, longStill + ("-o " + path("hung.exr") + " --checkpoint " + path("hung.ck") + " --json"),
               "LIMPID_TEST_SLOW_RANK=-1:100 LIMPID_CLUSTER_TIMEOUT=4");
    const Result result = signalOne(2, SIGSTOP, "hung.ck", command);
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_NE(result.output.find("process 2 on"), std::string::npos) << result.output;
    expectSame("one.exr", "hung.exr");
}

/// The slow one takes 2.5 s for a piece, the other one a tenth of that, and makes nearly all of 12: all but
/// one, or a few if the machine is busy. Equal shares would be 6.
TEST_F(CliClusterTest, ASlowProcessMakesFewPieces) {
    for (const int slow : {0, 1}) {
        const Result result = runTogether(2, std::string(longStill) + "--json -o " + path("slow.exr"),
                                          fmt::format("LIMPID_TEST_SLOW_RANK={}:2500", slow));
        expectDone(result);
        const std::vector<int> pieces = piecesIn(result);
        ASSERT_EQ(pieces.size(), 2u);
        EXPECT_LE(pieces[static_cast<size_t>(slow)], 4) << result.output;
        EXPECT_EQ(pieces[0] + pieces[1], 12) << result.output;
    }
}

TEST_F(CliClusterTest, AFaultEndsAllWithOneMessage) {
    const auto expectFault = [&](const Result& result, int code, const std::string& part) {
        EXPECT_EQ(result.code, code) << result.output;
        EXPECT_EQ(countOf(part, result.output), 1u) << result.output;
        EXPECT_LE(countOf("error: ", result.output), 1u) << result.output;
    };
    put("bad.glb", "not a scene");
    expectFault(runTogether(4, "render " + path("bad.glb") + " -o " + path("a.exr")), 3, "bad.glb: ");
    expectFault(runTogether(4, "render builtin:cornell --nosuch -o " + path("a.exr")), 2, "--nosuch");
    expectFault(runTogether(2, std::string(still) + "-o " + path("no/such.exr")), 1, "does not exist");
    // On one process only, and different work.
    const auto mixed = [&](const std::string& second) {
        return runProgram(fmt::format("env {} timeout 120 '{}' -n 1 '{}' {} -o {} : -n 1 '{}' {} -o {}",
                                      manners, LIMPID_MPIRUN, LIMPID_PROGRAM, still, path("a.exr"),
                                      LIMPID_PROGRAM, second, path("a.exr")));
    };
    expectFault(mixed("render " + path("bad.glb")), 3, "(process 1 on ");
    expectFault(mixed(still + std::string("--seed 7")), 3, "has other work");
    EXPECT_FALSE(fs::exists(path("a.exr")));
}

TEST_F(CliClusterTest, WhatSeveralCannotDoIsRefused) {
    const auto expectRefused = [&](const std::string& arguments, const std::string& part) {
        const Result result = runTogether(2, arguments);
        EXPECT_EQ(result.code, 2) << result.output;
        EXPECT_EQ(countOf(part, result.output), 1u) << result.output;
    };
    expectRefused(std::string(still) + "--shard 1/2 -o " + path("a.sums"), "--shard: ");
    expectRefused("render builtin:cornell-moving --frames 2 --denoiser svgf -o " + path("%d.exr"),
                  "build on each other");
    expectRefused("merge " + path("a.sums") + " -o " + path("a.exr"), "limpid merge is for one process");
    expectRefused("compare a.exr b.exr --error-map " + path("a.png"), "limpid compare is for one process");
}

/// So that the packages do not need MPI.
TEST_F(CliClusterTest, TheProgramIsNotLinkedToMpi) {
    const Result libraries = runProgram(std::string("LD_TRACE_LOADED_OBJECTS=1 '") + LIMPID_PROGRAM + "'");
    EXPECT_NE(libraries.output.find("libc.so"), std::string::npos) << libraries.output;
    EXPECT_EQ(libraries.output.find("libmpi"), std::string::npos) << libraries.output;
    const Result module = runProgram(std::string("LD_TRACE_LOADED_OBJECTS=1 '") + LIMPID_PROGRAM +
                                     "' --version; ldd '" + LIMPID_MPI_MODULE + "'");
    EXPECT_NE(module.output.find("libmpi"), std::string::npos) << module.output;
}

/// Needs no MPI: the variables of a launcher are enough.
TEST_F(CliTest, OneOfSeveralProcessesRefusesWhatItWouldRepeat) {
    const auto asProcess = [](int rank, const std::string& variables, const std::string& arguments) {
        return runProgram(fmt::format("OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK={} {} '{}' {}", rank,
                                      variables, LIMPID_PROGRAM, arguments));
    };
    for (const char* command : {"merge none.sums -o none.exr", "compare none.exr none.exr"}) {
        const Result refused = asProcess(0, "", command);
        EXPECT_EQ(refused.code, 2) << refused.output;
        EXPECT_NE(refused.output.find("is for one process"), std::string::npos) << refused.output;
        for (const char* alone : {"LIMPID_MPI=0", "OMPI_COMM_WORLD_SIZE=0"})
            EXPECT_EQ(asProcess(0, alone, command).code, 3) << "the file does not exist";
        EXPECT_EQ(asProcess(0, "", std::string(command) + " --help").code, 0);
    }
    const Result other = asProcess(1, "", "merge none.sums -o none.exr");
    EXPECT_EQ(other.code, 2);
    EXPECT_EQ(other.output, "") << "process 0 says it";
    const Result impatient = asProcess(0, "LIMPID_CLUSTER_TIMEOUT=-5", "render builtin:cornell -o a.exr");
    EXPECT_EQ(impatient.code, 2) << impatient.output;
    EXPECT_NE(impatient.output.find("LIMPID_CLUSTER_TIMEOUT: '-5'"), std::string::npos) << impatient.output;
}

/// Needs no MPI: the variables of a launcher are enough.
TEST(CliWithoutMpi, SaysWhatIsAbsent) {
    const fs::path folder = fs::temp_directory_path() / fmt::format("limpid_without_mpi.{}", ::getpid());
    fs::create_directories(folder);
    fs::copy_file(LIMPID_PROGRAM, folder / "limpid");
    const auto runCopy = [&](const std::string& variables) {
        const std::string command = fmt::format(
            "{} '{}' render builtin:cornell --spp 1 --width 8 --height 8 --device "
            "cpu -o '{}' 2>&1; echo code $?",
            variables, (folder / "limpid").string(), (folder / "a.exr").string());
        std::string output;
        FILE* const pipe = ::popen(command.c_str(), "r");
        std::array<char, 4096> buffer{};
        while (const size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe))
            output.append(buffer.data(), count);
        ::pclose(pipe);
        return output;
    };
    const std::string first = runCopy("OMPI_COMM_WORLD_RANK=0 OMPI_COMM_WORLD_SIZE=2");
    EXPECT_NE(first.find("limpid-mpi"), std::string::npos) << first;
    EXPECT_NE(first.find("code 1"), std::string::npos) << first;
    EXPECT_EQ(runCopy("OMPI_COMM_WORLD_RANK=1 OMPI_COMM_WORLD_SIZE=2"), "code 1\n") << "process 0 says it";
    EXPECT_FALSE(fs::exists(folder / "a.exr"));
    EXPECT_NE(runCopy("OMPI_COMM_WORLD_RANK=0 OMPI_COMM_WORLD_SIZE=1").find("code 0"), std::string::npos);
    EXPECT_NE(runCopy("LIMPID_MPI=0 OMPI_COMM_WORLD_RANK=0 OMPI_COMM_WORLD_SIZE=2").find("code 0"),
              std::string::npos);
    fs::remove_all(folder);
}

}  // namespace
}  // namespace limpid
