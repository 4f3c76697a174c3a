// Tests `limpid compare` as users and scripts use it: stills, sequences, exit codes.
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "image/io/exr/exr.h"
#include "image/io/png/png.h"
#include "image/metrics/geometry.h"
#include "image/metrics/metrics.h"
#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

using image::Image;
using image::LayeredImage;
using image::Storage;
using nlohmann::json;

constexpr uint32_t width = 40, height = 30;

/// A still texture, and sequences of a window on it that moves two pixels to the right per frame.
class CliCompareTest : public CliTest {
  protected:
    CliCompareTest() {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> uniform(0.1f, 0.4f);
        for (float& v : world_.pixels) v = uniform(random);
    }

    Image view(uint32_t left) const {
        Image image(width, height, 3);
        for (uint32_t y = 0; y < height; ++y) {
            for (uint32_t x = 0; x < width; ++x) {
                for (uint32_t c = 0; c < 3; ++c) image.at(x, y, c) = world_.at(x + left, y, c);
            }
        }
        return image;
    }
    static Image plus(Image image, float offset) {
        for (float& v : image.pixels) v += offset;
        return image;
    }
    /// `motion`: that of every pixel along x; none writes no layer.
    void putExr(const std::string& name, const Image& color, std::optional<float> motion = {}) const {
        LayeredImage layers;
        layers.add("", "RGB", color, Storage::Float);
        if (motion) {
            Image layer(color.width, color.height, 3, 0.0f);
            for (size_t i = 0; i < layer.pixels.size(); i += 3) layer.pixels[i] = *motion;
            layers.add("motion", "XYZ", layer, Storage::Float);
        }
        image::writeExr(folder_ / name, layers);
    }
    /// Writes moving frames ref.0001 to ref.0004, and test.0001 to test.0004 with the given brightness added.
    void putSequences(const std::vector<float>& errors, bool withMotion) const {
        for (size_t i = 0; i < errors.size(); ++i) {
            const std::string number = ".000" + std::to_string(i + 1) + ".exr";
            const Image picture = view(static_cast<uint32_t>(2 * i));
            // The first frame has no previous one.
            const float motion = i == 0 ? image::invalidMotion : 2.0f;
            putExr("ref" + number, picture, withMotion ? std::optional(motion) : std::nullopt);
            putExr("test" + number, plus(picture, errors[i]));
        }
    }
    json compareJson(const std::string& arguments) const {
        const Result result = run("compare --json " + arguments);
        EXPECT_EQ(result.code, 0) << result.output;
        return json::parse(result.output, nullptr, false);
    }
    std::string sequences() const { return path("test.%04d.exr") + " " + path("ref.%04d.exr"); }

    Image world_{80, height, 3};
};

TEST_F(CliCompareTest, StillsHaveHdrFlipWhereBothAreSceneReferred) {
    putExr("a.exr", plus(view(0), 0.1f));
    putExr("b.exr", view(0));
    const json both = compareJson(path("a.exr") + " " + path("b.exr") + " --error-map " + path("e.png") +
                                  " --hdr-error-map " + path("h.png"));
    EXPECT_GT(both["hdr_flip"].get<double>(), 0.01);
    EXPECT_GE(both["hdr_exposures"]["count"].get<int>(), 2);
    EXPECT_TRUE(fs::exists(folder_ / "e.png") && fs::exists(folder_ / "h.png"));
    const image::HdrFlip want = image::hdrFlip(plus(view(0), 0.1f), view(0));
    EXPECT_NEAR(both["hdr_flip"].get<double>(), want.value, 1e-9);
    image::writePng(folder_ / "c.png", image::toBytes(view(0)));
    EXPECT_TRUE(compareJson(path("c.png") + " " + path("b.exr"))["hdr_flip"].is_null());
    expect("compare " + path("c.png") + " " + path("b.exr") + " --hdr-error-map " + path("h.png"), 2,
           "c.png");
    expect("compare " + path("a.exr") + " " + path("b.exr"), 0, "hdr_flip");
}

TEST_F(CliCompareTest, ASequenceReportsEveryFrameMeanAndWorst) {
    putSequences({0.0f, 0.1f, 0.05f, 0.0f}, true);
    const json all = compareJson(sequences() + " --exposure 0");
    ASSERT_EQ(all["frames"].size(), 4u);
    EXPECT_EQ(all["frames"][0]["frame"], 1);
    EXPECT_TRUE(all["frames"][0]["psnr"].is_null()) << "equal: infinite";
    EXPECT_TRUE(all["frames"][0]["flicker"].is_null()) << "nothing came before";
    EXPECT_TRUE(all["mean"]["psnr"].is_null()) << "infinite, too";
    EXPECT_EQ(all["worst"]["psnr"]["frame"], 2);
    EXPECT_EQ(all["worst"]["flip"]["frame"], 2);
    double sum = 0.0;
    for (const json& frame : all["frames"]) sum += frame["relmse"].get<double>();
    EXPECT_NEAR(all["mean"]["relmse"].get<double>(), sum / 4.0, 1e-12);
    EXPECT_EQ(all["exposure"], 0.0);
    EXPECT_EQ(all["width"], width);
    // Each frame's scores equal those of the pair alone.
    const json pair = compareJson(path("test.0003.exr") + " " + path("ref.0003.exr") + " --exposure 0");
    for (const char* name : {"psnr", "ssim", "relmse", "flip", "hdr_flip"})
        EXPECT_EQ(all["frames"][2][name], pair[name]) << name;
}

TEST_F(CliCompareTest, FlickerFollowsTheReferencesMotion) {
    putSequences({0.1f, 0.1f, 0.1f}, true);
    const json steady = compareJson(sequences() + " --exposure 0");
    EXPECT_EQ(steady["motion"], "reference");
    EXPECT_NEAR(steady["frames"][1]["flicker_pixels"].get<double>(), 38.0 / 40.0, 1e-9);
    // A constant error in radiance is not exactly constant in sRGB, but it moves with the picture.
    EXPECT_NEAR(steady["mean"]["flicker"].get<double>(), 0.0, 1e-7);
    EXPECT_LT(steady["mean"]["psnr"].get<double>(), 30.0);
    EXPECT_TRUE(steady["frames"][0]["temporal_error"].is_null());
    EXPECT_NEAR(steady["mean"]["temporal_error"].get<double>(), 0.0, 0.02);

    putSequences({0.0f, 0.1f, 0.1f}, true);
    const json blinking = compareJson(sequences() + " --exposure 0");
    EXPECT_GT(blinking["frames"][1]["flicker"].get<double>(), 0.05);
    EXPECT_GT(blinking["frames"][1]["temporal_error"].get<double>(), 0.05);
    EXPECT_LT(blinking["frames"][2]["temporal_error"].get<double>(), 0.02);
    EXPECT_NEAR(blinking["frames"][2]["flicker"].get<double>(), 0.0, 1e-7);
    EXPECT_EQ(blinking["worst"]["flicker"]["frame"], 2);

    putSequences({0.0f, 0.1f, 0.1f}, false);
    const json without = compareJson(sequences() + " --exposure 0");
    EXPECT_EQ(without["motion"], "none");
    EXPECT_LT(without["frames"][1]["flicker"].get<double>(), blinking["frames"][1]["flicker"].get<double>())
        << "the movement is taken for the reference's own change";
    expect("compare " + sequences(), 0, "every pixel taken as still");
}

TEST_F(CliCompareTest, FlickerFollowsTheTestsMotionWhereTheReferenceHasNone) {
    for (uint32_t i = 0; i < 2; ++i) {
        const std::string number = ".000" + std::to_string(i + 1) + ".exr";
        putExr("ref" + number, view(2 * i));
        putExr("test" + number, view(2 * i), 2.0f);
    }
    const json all = compareJson(sequences());
    EXPECT_EQ(all["motion"], "test");
    EXPECT_EQ(all["mean"]["flicker"], 0.0);
}

TEST_F(CliCompareTest, OneReferenceServesAllFrames) {
    putExr("ref.exr", Image(width, height, 3, 0.18f));
    putExr("test.1.exr", Image(width, height, 3, 0.18f));
    putExr("test.2.exr", Image(width, height, 3, 0.36f));
    const json all = compareJson(path("test.%d.exr") + " " + path("ref.exr"));
    EXPECT_NEAR(all["exposure"].get<double>(), 0.0, 1e-4);
    const double change = image::displayEncode(Image(1, 1, 3, 0.36f), 0.0f).pixels[0] -
                          image::displayEncode(Image(1, 1, 3, 0.18f), 0.0f).pixels[0];
    EXPECT_NEAR(all["frames"][1]["flicker"].get<double>(), change, 1e-6);
    expect("compare " + path("ref.exr") + " " + path("test.%d.exr"), 2, "is a sequence");
}

TEST_F(CliCompareTest, OneExposureForAllFrames) {
    // Averages 2^-3 and 2^1 times 0.18: one stop more brings their geometric mean to 0.18.
    for (const auto& [number, value] : {std::pair{"1", 0.0225f}, {"2", 0.36f}}) {
        putExr("ref." + std::string(number) + ".exr", Image(width, height, 3, value));
        putExr("test." + std::string(number) + ".exr", Image(width, height, 3, value));
    }
    const json all = compareJson(path("test.%d.exr") + " " + path("ref.%d.exr"));
    EXPECT_NEAR(all["exposure"].get<double>(), 1.0, 1e-4);
}

TEST_F(CliCompareTest, SequencesOfPngsAndTheirMaps) {
    for (const char* name :
         {"ref.08.png", "ref.09.png", "ref.10.png", "test.08.png", "test.09.png", "test.10.png"})
        image::writePng(folder_ / name, image::toBytes(Image(width, height, 3, 0.5f)));
    const json all =
        compareJson(path("test.%02d.png") + " " + path("ref.%02d.png") + " --error-map " + path("e%03d.png"));
    EXPECT_EQ(all["exposure"], 0.0);
    EXPECT_TRUE(all["mean"]["hdr_flip"].is_null());
    EXPECT_EQ(all["frames"][2]["frame"], 10);
    for (const char* name : {"e008.png", "e009.png", "e010.png"})
        EXPECT_TRUE(fs::exists(folder_ / name)) << name;
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 9)
        << "no temporary file stays";
}

TEST_F(CliCompareTest, WrongUsageIsExitCode2) {
    putSequences({0.0f, 0.0f}, false);
    expect("compare " + path("test.%s.exr") + " " + path("ref.%04d.exr"), 2, "%s");
    expect("compare " + path("50%.exr") + " " + path("ref.0001.exr"), 2, "%%");
    expect("compare " + sequences() + " --error-map " + path("e.png"), 2, "needs a frame number");
    expect("compare " + sequences() + " --error-map " + path("e.%04d.exr"), 2, ".png");
    expect(
        "compare " + path("test.0001.exr") + " " + path("ref.0001.exr") + " --error-map " + path("e%d.png"),
        2, "one picture");
    const std::string pair = "compare " + path("test.0001.exr") + " " + path("m.png");
    expect(pair + " --error-map " + path("./m.png"), 2, "is REFERENCE");
    expect(pair + " --error-map " + path("e.png") + " --hdr-error-map " + path("e.png"), 2, "other map");
    expect("compare " + path("t%04d.png") + " " + path("m.png") + " --error-map " + path("t%d.png"), 2,
           "is TEST");
    expect("compare " + path("t%d.png") + " " + path("m7.png") + " --error-map " + path("m%d.png"), 2,
           "is REFERENCE");
    expect("compare " + sequences() + " --exposure bright", 2, "--exposure");
    expect("compare " + sequences() + " --error-map " + path("none/e%d.png"), 1, "does not exist");
}

TEST_F(CliCompareTest, SequencesThatDoNotFitAreExitCode3) {
    expect("compare " + sequences(), 3, "there is no such file");
    putSequences({0.0f, 0.0f, 0.0f, 0.0f}, false);
    fs::remove(folder_ / "test.0004.exr");
    expect("compare " + sequences(), 3, "its frames are 1-3, but those of");
    fs::remove(folder_ / "ref.0003.exr");
    fs::remove(folder_ / "test.0002.exr");
    expect("compare " + sequences(), 3, "test.%04d.exr: frame 2 is missing: there are 1, 3");
    putSequences({0.0f, 0.0f}, false);
    fs::remove(folder_ / "test.0003.exr");
    fs::remove(folder_ / "ref.0004.exr");
    put("test.0002.exr", "no picture");
    expect("compare " + sequences(), 3, "test.0002.exr");
    putExr("test.0002.exr", Image(3, 3, 3));
    expect("compare " + sequences(), 3, "is 3x3 pixels");
    putExr("ref.0002.exr", Image(3, 3, 3));
    expect("compare " + sequences(), 3, "the frames before are 40x30");
    putExr("ref.0002.exr", Image(3, 3, 3, std::nanf("")));
    expect("compare " + sequences(), 3, "ref.0002.exr: has 27 values that are NaN or infinite");
    expect("compare " + path("none/test.%d.exr") + " " + path("ref.%04d.exr"), 3, "cannot be read");
}

TEST_F(CliCompareTest, InvalidPixelsOfASequenceAreCountedAndNoNanComesOut) {
    putSequences({0.1f, 0.1f, 0.1f}, true);
    Image bad = view(2);
    bad.at(7, 8, 1) = std::nanf("");
    bad.at(9, 8, 1) = std::numeric_limits<float>::infinity();
    putExr("test.0002.exr", bad);
    const Result table = run("compare " + sequences());
    EXPECT_EQ(table.code, 0);
    EXPECT_NE(table.output.find("2 pixels are NaN or infinite (frames 2)"), std::string::npos)
        << table.output;
    const std::string output = run("compare --json " + sequences() + " 2>/dev/null").output;
    const json all = json::parse(output.substr(output.find('{')), nullptr, false);
    EXPECT_EQ(all["invalid_pixels"], 2);
    for (const json& frame : all["frames"]) {
        for (const char* name : {"psnr", "ssim", "relmse", "flip", "hdr_flip"})
            EXPECT_TRUE(frame[name].is_number());
    }
    EXPECT_TRUE(all["mean"]["flicker"].is_number());
}

}  // namespace
}  // namespace limpid
