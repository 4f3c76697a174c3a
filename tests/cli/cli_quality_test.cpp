// Tests `limpid bench quality` as users and scripts use it: reports, stored references, exit codes.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

using nlohmann::json;

class CliQualityTest : public CliTest {
  protected:
    static std::string options(const std::string& more) {
        return "bench quality --device cpu --width 48 --height 27 --first 1 --frames 4 --reference-spp 16 " +
               more;
    }
    static json numbers(const std::string& more) {
        const Result result = run(options("--json " + more));
        EXPECT_EQ(result.code, 0) << result.output;
        const size_t start = std::min(result.output.find('{'), result.output.size());  // skips the log
        return json::parse(result.output.substr(start), nullptr, false);
    }
    /// Removes values that may differ between runs: times, and the command line.
    static void dropTimes(json& value) {
        if (value.is_object()) {
            for (const char* name : {"command", "median_ms", "denoising_ms"}) value.erase(name);
        }
        if (value.is_structured()) {
            for (json& inner : value) dropTimes(inner);
        }
    }
    std::vector<fs::path> filesIn(const std::string& name) const {
        std::vector<fs::path> files;
        for (const auto& entry : fs::directory_iterator(folder_ / name)) files.push_back(entry.path());
        std::sort(files.begin(), files.end());
        return files;
    }
};

TEST_F(CliQualityTest, KeptReferencesGiveTheSameNumbersAndDamagedOnesAreRefused) {
    const std::string kept = "--denoiser temporal --reference-folder " + path("kept");
    json first = numbers(kept);
    const std::vector<fs::path> files = filesIn("kept");
    ASSERT_EQ(files.size(), 3u) << "one for each compared frame, and no temporary";
    for (const fs::path& file : files) {
        const std::string name = file.filename().string();
        EXPECT_TRUE(name.starts_with("cornell.48x27.16spp.")) << name;
    }
    const auto written = fs::last_write_time(files[0]);
    json second = numbers(kept);
    EXPECT_EQ(fs::last_write_time(files[0]), written) << "read, not rendered again";
    for (json* run : {&first, &second}) dropTimes(*run);
    EXPECT_EQ(first, second);
    EXPECT_GT(first["scenes"][0]["methods"][1]["denoising_bytes_per_pixel"].get<double>(), 4.0);
    json spread = numbers(kept + " --set pathtrace.sampler_tea=on");
    EXPECT_EQ(filesIn("kept").size(), 3u) << "the same for frames of every sampler";
    dropTimes(spread);
    EXPECT_NE(first["scenes"], spread["scenes"]);

    fs::copy_file(files[1], files[0], fs::copy_options::overwrite_existing);
    expect(options(kept), 3, files[0].filename().string() + ": is no reference of this frame");
    fs::resize_file(files[0], fs::file_size(files[0]) / 2);
    expect(options(kept), 3, files[0].filename().string());
    std::ofstream(files[0]) << "no picture";
    expect(options(kept), 3, files[0].filename().string());
    fs::remove(files[0]);
    numbers(kept + " --set pathtrace.max_depth=2");
    EXPECT_EQ(filesIn("kept").size(), 5u) << "of another path tracer";
}

TEST_F(CliQualityTest, AFoldersScenesAreMeasuredAndBadOnesSkippedLoudly) {
    fs::create_directories(folder_ / "scenes/bad");
    put("scenes/bad/bad.gltf", "no JSON");
    const std::string folder = "--denoiser temporal --scenes-folder " + path("scenes");
    expect(options(folder), 1, "SKIPPED: bad: ");
    const Result result = run(options(
        folder + " --quick --scene builtin:cornell --scene builtin:heavy --report " + path("page.html")));
    EXPECT_EQ(result.code, 0) << result.output;
    for (const char* part : {"SKIPPED: bad: ", "SKIPPED: heavy: has ", "cornell (reference: 16 samples, "})
        EXPECT_NE(result.output.find(part), std::string::npos) << result.output;
    const std::string page = get("page.html");
    for (const char* part : {"\"skipped\":[{\"name\":\"heavy\"", "\"name\":\"cornell\"", "--scenes-folder"})
        EXPECT_NE(page.find(part), std::string::npos) << part;
}

TEST_F(CliQualityTest, ScenesOfOneNameAreToldApart) {
    put("cornell-2.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Result result =
        run(options("--denoiser temporal --scene builtin:cornell --scene builtin:cornell --scene " +
                    path("cornell-2.obj") + " --out " + path("pictures")));
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_EQ(filesIn("pictures").size(), 3u);
}

TEST_F(CliQualityTest, WhatCannotBeIsSaidBeforeAnythingIsRendered) {
    expect(options("--denoiser nothing"), 2, "nothing");
    expect(options("--report " + path("none/page.html")), 1, "does not exist");
    expect(options("--scenes-folder " + path("none")), 3, "cannot be read");
    fs::create_directories(folder_ / "empty");
    expect(options("--scenes-folder " + path("empty")), 3, "has no glTF files");
    expect(options("--scene builtin:cornell --scene none.glb"), 3, "none.glb: does not exist");
    expect(options("--scene builtin:cornell --env none.hdr"), 3, "none.hdr: does not exist");
    expect(options("--camera-path none.json"), 3, "none.json");
    fs::create_directories(folder_ / "scenes/a");
    put("scenes/a/a.gltf", "");
    const std::string paths = "--paths-folder " + path("none");
    expect(options("--scenes-folder " + path("scenes ") + paths), 3, "is no folder");
    expect(options(paths), 2, "--paths-folder goes with --scenes-folder");
    for (const char* option : {"--env a.hdr", "--camera-path dolly"})
        for (const char* lab : {" --lab", " --quick"})
            expect(std::string("bench quality ") + option + lab, 2, "the sequences of --lab have their own");
    put("file", "");
    for (const char* option : {"--out ", "--reference-folder "})
        expect(options(option + path("file")), 1, "cannot be made");
    expect(options("--denoiser none"), 2, "--denoiser none: it is scored anyway");
    expect(options("--integrator gbuffer --denoiser svgf"), 2, "--integrator gbuffer takes no denoiser");
    for (const char* frames : {"--first 61", "--frames 16", "--lab --first 36", "--quick --frames 6"})
        expect(std::string("bench quality --device cpu ") + frames, 2, "cornell: of ");
}

TEST_F(CliQualityTest, TheReportWorksInABrowser) {
    const Result made = run(options("--report " + path("page.html") + " --lab --quick --denoiser temporal"));
    ASSERT_EQ(made.code, 0) << made.output;
    for (const char* part : {"best in", "many-lights (reference: 16 samples, "})
        EXPECT_NE(made.output.find(part), std::string::npos) << made.output;
    const std::string script = std::string(LIMPID_SOURCE_DIR) + "/tests/cli/quality_page_browser.py";
    const Result result = runProgram("python3 '" + script + "' '" + path("page.html") + "'");
    if (result.code == 77) GTEST_SKIP() << result.output;
    EXPECT_EQ(result.code, 0) << result.output;
}

}  // namespace
}  // namespace limpid
