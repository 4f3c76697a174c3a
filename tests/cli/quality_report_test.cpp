// Tests the report of `limpid bench quality`: its numbers, its page, and the escaping of the page's data.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>

#include "base/error.h"
#include "image/io/png/png.h"
#include "image/io/temp_folder.h"
#include "lab/quality/quality_message.h"
#include "lab/quality/quality_methods.h"
#include "lab/quality/quality_sequences.h"
#include "lab/quality/report/picture_label.h"
#include "lab/quality/report/quality_json.h"
#include "lab/quality/report/quality_page.h"
#include "lab/quality/report/quality_ranking.h"
#include "scene/builtin/builtin.h"

namespace limpid::cli {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr gpu::Extent extent{8, 5};

std::vector<char> pngOf(const image::Image& picture) {
    return image::encodePng(image::toBytes(picture), "picture");
}

MethodQuality methodOf(const std::string& name, double psnr, double flip, double ms) {
    MethodQuality method;
    method.name = name;
    for (int frame = 6; frame < 9; ++frame) {
        image::FrameScores scores{.frame = frame, .psnr = psnr + frame, .ssim = 0.5, .relMse = 0.25};
        scores.flip = flip;
        if (frame > 6) scores.flicker = 0.001 * frame;
        method.scores.push_back(scores);
        if (ms > 0.0) method.denoisingMs.push_back(ms * frame);
    }
    if (ms > 0.0) {
        method.medianMs = {{"pathtrace", 1.0}, {name + "/pass", ms}};
        method.denoisingBytesPerPixel = 40.0;
    }
    method.last = image::Image(extent.width, extent.height, 3, 0.5f);
    method.pictures.assign(3, pngOf(method.last));
    method.errorMaps.assign(3, pngOf({extent.width, extent.height, 1, static_cast<float>(flip)}));
    return method;
}

MeasuredSequence sequenceOf(const std::string& name, double flipA, double flipB) {
    MeasuredSequence measured{
        .sequence = {.name = name, .scene = "builtin:x", .frames = {6, 9}, .referenceSamples = 256}};
    measured.triangles = 36;
    measured.quality.methods = {methodOf("noisy", 10.0, 0.5, 0.0), methodOf("a", 20.0, flipA, 1.0),
                                methodOf("b", 30.0, flipB, 2.0)};
    measured.quality.referencePsnr = 52.5;
    measured.quality.exposure = 1.5f;
    measured.quality.reference = image::Image(extent.width, extent.height, 3, 0.25f);
    measured.quality.referencePictures.assign(3, pngOf(measured.quality.reference));
    return measured;
}

QualityRun runOf() {
    QualityRun run{.version = "1.2.3",
                   .command = "limpid bench quality --quick",
                   .device = "a device",
                   .driver = "its driver",
                   .tracer = "compute",
                   .extent = extent,
                   .samples = 1};
    run.sequences = {sequenceOf("first", 0.2, 0.1), sequenceOf("second", 0.2, 0.2)};
    return run;
}

/// Returns the page's data as a browser finds it: up to the first end of a script element.
json dataOf(const std::string& page) {
    const std::string start = R"(<script type="application/json" id="data">)";
    const size_t from = page.find(start) + start.size();
    return json::parse(page.substr(from, page.find("</script", from) - from), nullptr, false);
}

std::vector<std::byte> decoded(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::vector<std::byte> bytes;
    uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=') break;
        bits = bits << 6 | static_cast<uint32_t>(digits.find(c));
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes.push_back(static_cast<std::byte>(bits >> count & 255u));
    }
    return bytes;
}

void expectPicture(const json& uri) {
    const std::string start = "data:image/png;base64,";
    ASSERT_TRUE(uri.is_string());
    const auto text = uri.get<std::string>();
    ASSERT_THAT(text, testing::StartsWith(start));
    const image::ByteImage picture = image::decodeImage(decoded(text.substr(start.size())), "picture");
    EXPECT_EQ(picture.width, extent.width);
    EXPECT_EQ(picture.height, extent.height);
}

void expectPictures(const json& uris) {
    ASSERT_EQ(uris.size(), 3u) << "one of every frame";
    for (const json& uri : uris) expectPicture(uri);
}

std::vector<bool> keptWithin(uint64_t bytes) {
    MeasuredSequence measured = sequenceOf("first", 0.2, 0.1);
    SequenceQuality& quality = measured.quality;
    const std::vector<char> kilobyte(1000);
    quality.referencePictures.assign(7, kilobyte);
    for (MethodQuality& method : quality.methods) {
        method.pictures.assign(7, kilobyte);
        method.errorMaps.assign(7, kilobyte);
    }
    keepWithin(quality, bytes);
    std::vector<bool> kept;
    for (const auto& picture : quality.referencePictures) kept.push_back(!picture.empty());
    for (const MethodQuality& method : quality.methods) {
        for (size_t i = 0; i < kept.size(); ++i) {
            EXPECT_EQ(!method.pictures[i].empty(), kept[i]);
            EXPECT_EQ(!method.errorMaps[i].empty(), kept[i]);
        }
    }
    return kept;
}

TEST(QualityReport, FramesThatAreTooMuchAreLeftOutEvenlyAndTheLastStays) {
    // Seven frames of seven pictures of 1000 bytes.
    EXPECT_THAT(keptWithin(49'000), ElementsAre(true, true, true, true, true, true, true));
    EXPECT_THAT(keptWithin(48'999), ElementsAre(true, false, true, false, true, false, true));
    EXPECT_THAT(keptWithin(27'999), ElementsAre(true, false, false, true, false, false, true));
    EXPECT_THAT(keptWithin(14'000), ElementsAre(false, false, true, false, false, false, true));
    EXPECT_THAT(keptWithin(1), ElementsAre(false, false, false, false, false, false, true));
    MeasuredSequence measured = sequenceOf("first", 0.2, 0.1);
    keepWithin(measured.quality, 1);
    QualityRun run = runOf();
    run.sequences = {measured};
    const json scene = dataOf(qualityPage(run))["scenes"][0];
    EXPECT_TRUE(scene["methods"][0]["pictures"][0].is_null());
    expectPicture(scene["methods"][0]["pictures"][2]);
}

TEST(PictureLabel, IsInsideItsPlaceAndReadable) {
    image::ByteImage picture{40, 60, 3, std::vector<uint8_t>(size_t{40} * 60 * 3, 100)};
    drawLabel(picture, {20, 5, 16, 55}, {"I", "-\xff"});
    const auto at = [&](uint32_t x, uint32_t y) { return picture.pixels[(size_t{y} * 40 + x) * 3]; };
    std::string rows;
    for (uint32_t y = 7; y < 14; ++y) {
        for (uint32_t x = 22; x < 27; ++x) rows += at(x, y) == 255 ? '#' : at(x, y) == 25 ? '.' : '?';
        rows += ' ';
    }
    EXPECT_EQ(rows, "###.. .#... .#... .#... .#... .#... ###.. ");
    for (uint32_t x = 0; x < 40; ++x) {
        for (uint32_t y = 0; y < 60; ++y) {
            const bool inside = x >= 20 && x < 36 && y >= 5;
            EXPECT_TRUE(inside || at(x, y) == 100) << x << ", " << y;
        }
    }
}

TEST(QualityReport, Base64IsThatOfRfc4648) {
    const std::vector<std::pair<std::string, std::string>> known{{"", ""},
                                                                 {"f", "Zg=="},
                                                                 {"fo", "Zm8="},
                                                                 {"foo", "Zm9v"},
                                                                 {"foob", "Zm9vYg=="},
                                                                 {"fooba", "Zm9vYmE="},
                                                                 {"foobar", "Zm9vYmFy"},
                                                                 {"\xff\xfe\xfb", "//77"}};
    for (const auto& [plain, text] : known) EXPECT_EQ(base64(plain), text);
}

TEST(QualityReport, NothingInTheDataCanEndItsElementOrBeginAComment) {
    const nlohmann::ordered_json value{{"</script><script>alert(1)</script>", "<!-- <script"},
                                       {"b", "]]> &amp; \" \\ \n \u2028 \u00e9"}};
    const std::string text = jsonForScript(value);
    EXPECT_EQ(text.find_first_of("<>&\n"), std::string::npos) << text;
    for (const char c : text) EXPECT_LT(static_cast<unsigned char>(c), 128);
    EXPECT_EQ(nlohmann::ordered_json::parse(text), value);
    EXPECT_EQ(json::parse(jsonForScript({{"name", "bad \xff bytes"}}))["name"], "bad \ufffd bytes");
}

TEST(QualityReport, ThePageHasEverything) {
    QualityRun run = runOf();
    const std::string hostile = "</script><!-- <script> & 'x'";
    run.sequences[1].sequence.name = hostile;
    run.skipped = {{"third", "scene.gltf: is not JSON"}};
    const std::string page = qualityPage(run);
    const json data = dataOf(page);
    ASSERT_TRUE(data.is_object()) << page.substr(0, 200);
    EXPECT_EQ(data["device"], "a device");
    EXPECT_EQ(data["driver"], "its driver");
    EXPECT_EQ(data["command"], "limpid bench quality --quick");
    EXPECT_EQ(data["width"], extent.width);
    EXPECT_EQ(data["skipped"][0]["reason"], "scene.gltf: is not JSON");
    ASSERT_EQ(data["scenes"].size(), 2u);
    EXPECT_EQ(data["scenes"][1]["name"], hostile);
    EXPECT_EQ(data["ranking"].size(), 3u);
    for (const json& scene : data["scenes"]) {
        EXPECT_EQ(scene["reference_psnr"], 52.5);
        EXPECT_EQ(scene["reference_samples"], 256);
        expectPictures(scene["reference_pictures"]);
        ASSERT_EQ(scene["methods"].size(), 3u);
        for (const json& method : scene["methods"]) {
            expectPictures(method["pictures"]);
            expectPictures(method["error_maps"]);
            EXPECT_EQ(method["frames"].size(), 3u);
        }
    }
}

TEST(QualityReport, ThePageAsksForNothingElse) {
    const std::string page = qualityPage(runOf());
    for (const char* outside : {"http:", "https:", "src=\"", "@import", "url("}) {
        size_t at = page.find(outside);
        // The SVG namespace is not an address that is loaded.
        if (at != std::string::npos && page.compare(at, 26, "http://www.w3.org/2000/svg") == 0)
            at = page.find(outside, at + 1);
        EXPECT_EQ(at, std::string::npos) << page.substr(at, 80);
    }
    EXPECT_THAT(page, HasSubstr("default-src 'none'"));
    EXPECT_THAT(page, Not(HasSubstr("@QUALITY_JSON@")));
}

TEST(QualityReport, JsonHasEveryFrameAndNullsForWhatThereIsNot) {
    QualityRun run = runOf();
    run.sequences[0].quality.methods[1].scores[2].psnr = std::numeric_limits<double>::infinity();
    const json data = json::parse(qualityJson(run).dump());
    const json& scene = data["scenes"][0];
    EXPECT_EQ(scene["first_frame"], 6);
    EXPECT_EQ(scene["frames"], 9);
    const json& a = scene["methods"][1];
    EXPECT_TRUE(a["psnr"]["mean"].is_null()) << "infinite";
    EXPECT_TRUE(a["frames"][2]["psnr"].is_null());
    EXPECT_EQ(a["frames"][1]["psnr"], 27.0);
    EXPECT_EQ(a["frames"][1]["frame"], 7);
    EXPECT_TRUE(a["frames"][0]["flicker"].is_null()) << "nothing came before";
    EXPECT_EQ(a["denoising_ms"], 7.0);
    EXPECT_EQ(a["denoising_bytes_per_pixel"], 40.0);
    EXPECT_EQ(a["median_ms"]["a/pass"], 1.0);
    EXPECT_TRUE(scene["methods"][0]["denoising_ms"].is_null()) << "the noisy frames are not denoised";
}

TEST(QualityReport, MethodsAreRankedByMeanFlip) {
    const std::vector<MethodRank> ranks = rankMethods(runOf());
    ASSERT_EQ(ranks.size(), 3u);
    EXPECT_EQ(ranks[0].name, "b");
    EXPECT_DOUBLE_EQ(ranks[0].flip, 0.15);
    EXPECT_DOUBLE_EQ(ranks[0].rank, 1.25) << "first, and once equal";
    EXPECT_DOUBLE_EQ(*ranks[0].gain, 20.0);
    EXPECT_DOUBLE_EQ(*ranks[0].denoisingMs, 14.0);
    EXPECT_THAT(ranks[0].best, ElementsAre("first", "second"));
    EXPECT_EQ(ranks[1].name, "a");
    EXPECT_DOUBLE_EQ(ranks[1].rank, 1.75);
    EXPECT_THAT(ranks[1].best, ElementsAre("second"));
    EXPECT_EQ(ranks[2].name, "noisy");
    EXPECT_FALSE(ranks[2].denoisingMs);
    EXPECT_THAT(ranks[2].best, IsEmpty());
    EXPECT_THAT(rankMethods({}), IsEmpty());
}

TEST(QualityReport, APageIntoNoFolderIsAnError) {
    EXPECT_THROW(writeQualityPage("/no such folder/page.html", runOf()), OutputError);
}

std::vector<std::string> denoisersOf(const MethodChoice& choice) {
    std::vector<std::string> names;
    for (const QualityMethod& method : methodsOf(choice, {}))
        names.emplace_back(method.settings.pipeline.denoiser->name);
    return names;
}

TEST(QualityMethods, AVariantIsOfTheDenoiserWhoseParametersItNames) {
    EXPECT_THAT(denoisersOf({{"temporal", "svgf", "kpcn"},
                             {"svgf.levels=1", "temporal.normal=0.5", "pathtrace.max_depth=2",
                              "preset=svgf-paper", "pathtrace.max_depth=2,svgf.levels=2"}}),
                ElementsAre("temporal", "svgf", "kpcn", "svgf", "temporal", "kpcn", "svgf", "svgf"));
    EXPECT_THAT(
        denoisersOf({{"temporal", "atrous", "svgf"}, {"preset=history-tracking-course,taa.frames=2"}}),
        ElementsAre("temporal", "atrous", "svgf", "atrous"));
    EXPECT_THAT(denoisersOf({{"atrous"}, {"temporal.normal=0.5"}}), ElementsAre("atrous", "atrous"))
        << "which has no parameters of a denoiser of that name, but those of temporal accumulation";
    EXPECT_THAT(denoisersOf({{"nano", "temporal"}, {"svgf.levels=1,taa.frames=1", "taa.frames=1"}}),
                ElementsAre("nano", "temporal", "nano", "temporal"))
        << "which reads svgf's parameters, too";
    EXPECT_THAT(denoisersOf({{"svgf", "nano"}, {"svgf.levels=1", "nano.strength=0.5"}}),
                ElementsAre("svgf", "nano", "svgf", "nano"));
    const auto methods = methodsOf({{"svgf"}, {"svgf.levels=1,svgf.wide=on"}}, {});
    EXPECT_EQ(methods[1].name, "svgf.levels=1,svgf.wide=on");
    EXPECT_EQ(methods[1].settings.denoisers.svgf.levels, 1);
    EXPECT_TRUE(methods[1].settings.denoisers.svgf.wide);
    EXPECT_NE(methods[0].settings.denoisers.svgf.levels, 1);
}

TEST(QualityMethods, StepsAreOfSvgfWhateverElseIsCompared) {
    const auto names = denoisersOf({.denoisers = {"temporal"}, .variants = {}, .steps = true});
    EXPECT_GT(names.size(), 10u);
    EXPECT_EQ(std::ranges::count(names, "svgf"), static_cast<long>(names.size()) - 1);
}

TEST(QualityMethods, WhatIsNoMethodIsRefused) {
    EXPECT_THROW(methodsOf({{"gbuffer"}, {}}, {}), UsageError);
    EXPECT_THROW(methodsOf({{"nothing"}, {}}, {}), UsageError);
    for (const char* variant :
         {"", "svgf.nothing=1", "svgf.levels", "preset=nothing", "preset=history-tracking-course"})
        EXPECT_THROW(methodsOf({{"svgf"}, {variant}}, {}), UsageError) << variant;
}

TEST(QualitySequences, TheLaboratorysScenesExistUnderNamesOfTheirOwn) {
    std::set<std::string> names, scenes;
    for (const scene::BuiltinInfo& info : scene::builtinScenes()) scenes.insert("builtin:" + info.name);
    for (const QualitySequence& sequence : labSequences()) {
        EXPECT_TRUE(names.insert(sequence.name).second) << sequence.name;
        EXPECT_TRUE(scenes.contains(sequence.scene)) << sequence.scene;
        EXPECT_LT(sequence.frames.first, sequence.frames.count) << sequence.name;
        EXPECT_GE(sequence.referenceSamples, 1024u) << sequence.name;
    }
}

TEST(QualitySequences, AFoldersScenesAreFoundOneLevelDown) {
    namespace fs = std::filesystem;
    const image::test::TempFolder folder;
    const auto put = [&](const std::string& file) {
        fs::create_directories((folder / file).parent_path());
        image::test::put(folder / file, "x");
    };
    for (const char* file :
         {"scenes/top.gltf", "scenes/lamp/lamp.GLB", "scenes/lamp/lamp.png", "scenes/two/b.gltf",
          "scenes/two/a.gltf", "scenes/deep/er/x.glb", "paths/lamp.json"})
        put(file);
    const auto found =
        sequencesInFolder(folder / "scenes", folder / "paths", {.cameraPath = "dolly", .frames = {1, 5}});
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].name, "lamp");
    EXPECT_EQ(found[0].cameraPath, (folder / "paths/lamp.json").string());
    EXPECT_EQ(found[1].name, "two-a");
    EXPECT_EQ(found[1].cameraPath, "dolly");
    EXPECT_EQ(found[2].scene, (folder / "scenes/two/b.gltf").string());
    EXPECT_TRUE(found[2].optional);
    EXPECT_THROW(sequencesInFolder(folder / "none", {}, {}), InputError);
}

TEST(QualityMessage, SequencesArriveAsTheyWere) {
    QualityRun run = runOf(), other = run;
    run.sequences[1].quality.methods[1].last.pixels[7] = 3.5f;
    const auto message = encodeOutcomes(
        {{0, run.sequences[0]}, {3, run.sequences[1]}, {5, SkippedSequence{"third", "has no light"}}});
    QualityOutcomes arrived = decodeOutcomes(message);
    ASSERT_EQ(arrived.size(), 3u);
    for (size_t i = 0; i < 2; ++i) {
        auto& measured = std::get<MeasuredSequence>(arrived.at(3 * i));
        measured.sequence = run.sequences[i].sequence;  // is not sent
        other.sequences[i] = measured;
    }
    EXPECT_EQ(qualityPage(other), qualityPage(run)) << "all numbers and pictures";
    EXPECT_EQ(other.sequences[1].quality.methods[1].last.pixels,
              run.sequences[1].quality.methods[1].last.pixels);
    EXPECT_EQ(other.sequences[0].quality.reference.pixels, run.sequences[0].quality.reference.pixels);
    EXPECT_EQ(std::get<SkippedSequence>(arrived.at(5)).name, "third");
    EXPECT_EQ(std::get<SkippedSequence>(arrived.at(5)).reason, "has no light");
}

TEST(QualityMessage, WhatIsCutOffOrTooLongIsRefused) {
    auto message = encodeOutcomes({{0, sequenceOf("first", 0.2, 0.1)}});
    for (size_t length = 0; length < message.size(); length += 5)
        EXPECT_THROW(decodeOutcomes(std::span(message).first(length)), Error) << length;
    message.push_back(std::byte{0});
    EXPECT_THROW(decodeOutcomes(message), Error);
}

}  // namespace
}  // namespace limpid::cli
