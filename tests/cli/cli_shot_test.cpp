// Tests `limpid denoise` on files of other renderers: Limpid's frames with the names and encodings of Cycles,
// and frames that Blender wrote (tests/data/shots).
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "image/io/exr/exr.h"
#include "image/io/exr/exr_document.h"
#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

using image::Image;
using image::LayeredImage;
using image::Storage;
using testing::HasSubstr;
using testing::Not;

constexpr uint32_t width = 96, height = 54;
constexpr int frames = 8;
const std::string size = fmt::format(" --device cpu --width {} --height {} ", width, height);

double meanError(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0.0;
    for (size_t i = 0; i < a.size(); ++i) {
        const auto shown = [](float v) { return std::max(v, 0.0f) / (1.0f + std::max(v, 0.0f)); };
        sum += std::abs(static_cast<double>(shown(a[i]) - shown(b[i])));
    }
    return sum / static_cast<double>(a.size());
}

class CliShotTest : public CliTest {
  protected:
    void SetUp() override {
        CliTest::SetUp();
        const std::string scene =
            "render builtin:cornell-moving --camera-path shake --frames 8 --float" + size;
        const Result noisy = run(scene + "--spp 1 --jitter off --aov all -o " + path("own.%02d.exr"));
        ASSERT_EQ(noisy.code, 0) << noisy.output;
    }

    Result denoise(const std::string& in, const std::string& out, const std::string& options = {}) {
        return run("denoise " + path(in) + " -o " + path(out) + " --device cpu " + options);
    }

    std::vector<float> colors(const std::string& file, const std::string& layer = {}) {
        return image::readExr(path(file)).get(layer, "RGB").pixels;
    }

    /// Writes the frames as Cycles names and encodes its passes.
    void writeAsCycles(const std::string& out) {
        for (int frame = 0; frame < frames; ++frame) {
            const LayeredImage own = image::readExr(path(fmt::format("own.{:02}.exr", frame)));
            LayeredImage file;
            file.width = width;
            file.height = height;
            const auto add = [&](const std::string& pass, const std::string& suffixes, const Image& values) {
                file.add("ViewLayer." + pass, suffixes, values, Storage::Float);
            };
            add("Combined", "RGBA", own.get("", "RGBA"));
            addLight(own, "diffuse", "albedo", "Diff", file);
            addLight(own, "specular", "albedoSpecular", "Gloss", file);
            add("Emit", "RGB", own.get("emission", "RGB"));
            add("Normal", "XYZ", own.get("normal", "XYZ"));
            add("IndexOB", "X", own.get("id", "I"));
            Image vector = own.get("motion", "XY"), depth = own.get("depth", "Z");
            for (size_t i = 0; i < vector.pixels.size(); ++i)
                vector.pixels[i] =
                    std::abs(vector.pixels[i]) > 1e9f ? 0.0f : vector.pixels[i] * (i % 2 == 0 ? 1.0f : -1.0f);
            add("Vector", "XY", vector);
            // Of a camera 40 degrees high, from the distance along the ray.
            for (uint32_t y = 0; y < height; ++y)
                for (uint32_t x = 0; x < width; ++x)
                    if (depth.at(x, y, 0) < 1e9f) depth.at(x, y, 0) /= rayLength(x, y);
            add("Depth", "Z", depth);
            file.metadata["cycles.ViewLayer.samples"] = "1";
            image::writeExr(path(fmt::format(fmt::runtime(out), frame)), file);
        }
    }

    /// The light divided by its albedo is "direct".
    static void addLight(const LayeredImage& own, const std::string& light, const std::string& albedo,
                         const std::string& name, LayeredImage& file) {
        const Image color = own.get(albedo, "RGB");
        Image direct = own.get(light, "RGB");
        for (size_t i = 0; i < direct.pixels.size(); ++i)
            direct.pixels[i] = color.pixels[i] > 0.0f ? direct.pixels[i] / color.pixels[i] : 0.0f;
        file.add("ViewLayer." + name + "Dir", "RGB", direct, Storage::Float);
        file.add("ViewLayer." + name + "Ind", "RGB", Image(width, height, 3), Storage::Float);
        file.add("ViewLayer." + name + "Col", "RGB", color, Storage::Float);
    }

    /// Of the ray through a pixel's centre, whose component along the axis is 1: the camera is in the files.
    float rayLength(uint32_t x, uint32_t y) {
        if (tangents_[0] == 0.0f) {
            float v[12];
            const std::string text = image::readExr(path("own.00.exr")).metadata.at("limpid.camera");
            std::sscanf(text.c_str(),
                        "perspective origin %f %f %f forward %f %f %f right %f %f %f up %f %f %f", v, v + 1,
                        v + 2, v + 3, v + 4, v + 5, v + 6, v + 7, v + 8, v + 9, v + 10, v + 11);
            tangents_[0] = std::hypot(v[6], v[7], v[8]);
            tangents_[1] = std::hypot(v[9], v[10], v[11]);
        }
        const float sx = (2.0f * (static_cast<float>(x) + 0.5f) / width - 1.0f) * tangents_[0];
        const float sy = (1.0f - 2.0f * (static_cast<float>(y) + 0.5f) / height) * tangents_[1];
        return std::sqrt(1.0f + sx * sx + sy * sy);
    }

    float tangents_[2] = {0.0f, 0.0f};
};

TEST_F(CliShotTest, FilesNamedLikeCyclesComeOutNearlyAsCleanAsOurOwn) {
    writeAsCycles("cycles.{:02}.exr");
    ASSERT_EQ(
        run("render builtin:cornell-moving --camera-path shake --frames 8 --jitter off --spp 96 --float" +
            size + "-o " + path("reference.%02d.exr"))
            .code,
        0);
    ASSERT_EQ(denoise("own.%02d.exr", "own-clean.%02d.exr").code, 0);
    const Result result = denoise("cycles.%02d.exr", "clean.%02d.exr", "--set taa.frames=1");
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_THAT(result.output, Not(HasSubstr("is missing")));
    const Result both = denoise("cycles.%02d.exr", "both.%02d.exr", "--set taa.frames=1 --bidirectional");
    ASSERT_EQ(both.code, 0) << both.output;
    double noisy = 0.0, own = 0.0, clean = 0.0, merged = 0.0;
    for (const char* frame : {"00", "05", "07"}) {
        const std::string end = std::string(".") + frame + ".exr";
        const auto reference = colors("reference" + end);
        noisy += meanError(colors("own" + end), reference);
        own += meanError(colors("own-clean" + end), reference);
        clean += meanError(colors("clean" + end, "ViewLayer.Combined"), reference);
        merged += meanError(colors("both" + end, "ViewLayer.Combined"), reference);
    }
    fmt::print("error: noisy {:.4f}, own {:.4f}, named like Cycles {:.4f}, both ways {:.4f}\n", noisy, own,
               clean, merged);
    EXPECT_LT(own, 0.35 * noisy);
    EXPECT_LT(clean, 1.2 * own);
    EXPECT_LT(merged, clean) << "the first frame has a future";
    const image::ExrDocument before = image::ExrDocument::read(path("cycles.07.exr"));
    image::ExrDocument input = image::ExrDocument::read(path("cycles.07.exr"));
    image::ExrDocument output = image::ExrDocument::read(path("clean.07.exr"));
    ASSERT_EQ(output.parts().size(), 1u);
    for (const auto& channel : before.parts()[0].channels) {
        const bool changes = channel.name.starts_with("ViewLayer.Combined.") && !channel.name.ends_with("A");
        EXPECT_EQ(input.values(0, channel.name) == output.values(0, channel.name), !changes) << channel.name;
    }
    EXPECT_EQ(output.parts()[0].texts.at("cycles.ViewLayer.samples"), "1");
    EXPECT_EQ(output.parts()[0].texts.at("limpid.denoiser"), "svgf");
    ASSERT_EQ(denoise("own.%02d.exr", "nano-own.%02d.exr", "--denoiser nano").code, 0);
    const Result network =
        denoise("cycles.%02d.exr", "nano.%02d.exr", "--denoiser nano --set taa.frames=1 --bidirectional");
    ASSERT_EQ(network.code, 0) << network.output;
    double ofOwn = 0.0, ofBoth = 0.0;
    for (const char* frame : {"00", "05", "07"}) {
        const std::string end = std::string(".") + frame + ".exr";
        const auto reference = colors("reference" + end);
        ofOwn += meanError(colors("nano-own" + end), reference);
        ofBoth += meanError(colors("nano" + end, "ViewLayer.Combined"), reference);
    }
    fmt::print("by nano: own {:.4f}, named like Cycles both ways {:.4f}\n", ofOwn, ofBoth);
    EXPECT_LT(ofOwn, 1.1 * own);
    EXPECT_LT(ofBoth, ofOwn);
    const auto beautyOf = [&](const std::string& options) {
        EXPECT_EQ(denoise("cycles.05.exr", "one.exr", options).code, 0) << options;
        return colors("one.exr", "ViewLayer.Combined");
    };
    for (const std::string method : {"svgf", "nano"})
        EXPECT_EQ(beautyOf("--denoiser " + method), beautyOf("--denoiser " + method + " --recover on"));
    EXPECT_EQ(beautyOf("--denoiser atrous"), beautyOf("--denoiser atrous --recover off"));
    EXPECT_NE(beautyOf("--denoiser nano"), beautyOf("--denoiser nano --recover off"));
}

/// Beauty, albedo and normal are what other denoisers take: motion is searched, in both directions.
TEST_F(CliShotTest, MotionIsSearchedWhereFilesHaveNone) {
    ASSERT_EQ(
        run("render builtin:cornell-moving --camera-path shake --frames 8 --jitter off --spp 96 --float" +
            size + "-o " + path("reference.%02d.exr"))
            .code,
        0);
    for (int frame = 0; frame < frames; ++frame) {
        const LayeredImage own = image::readExr(path(fmt::format("own.{:02}.exr", frame)));
        LayeredImage few;
        few.width = width;
        few.height = height;
        few.add("", "RGB", own.get("", "RGB"), Storage::Float);
        few.add("albedo", "RGB", own.get("albedo", "RGB"), Storage::Float);
        few.add("normal", "XYZ", own.get("normal", "XYZ"), Storage::Float);
        image::writeExr(path(fmt::format("few.{:02}.exr", frame)), few);
    }
    /// Of the first frame, and of one that has a history.
    const auto errorsOf = [&](const std::string& options, const char* said, bool isSaid) {
        const Result result = denoise("few.%02d.exr", "clean.%02d.exr", options);
        EXPECT_EQ(result.code, 0) << result.output;
        EXPECT_EQ(result.output.find(said) != std::string::npos, isSaid) << result.output;
        return std::pair(meanError(colors("clean.00.exr"), colors("reference.00.exr")),
                         meanError(colors("clean.05.exr"), colors("reference.05.exr")));
    };
    const char* const searched = "it is searched by block matching on albedo and normals";
    const auto alone = errorsOf("--motion none", searched, false), found = errorsOf("", searched, true);
    const auto both = errorsOf("--bidirectional", searched, true);
    fmt::print(
        "errors: each frame alone {:.4f} {:.4f}, searched motion {:.4f} {:.4f}, both ways {:.4f} {:.4f}\n",
        alone.first, alone.second, found.first, found.second, both.first, both.second);
    EXPECT_LT(found.second, 0.8 * alone.second);
    EXPECT_LT(both.first, 0.8 * found.first) << "the first frame has a future";
    EXPECT_LT(both.second, 0.8 * alone.second);
    EXPECT_EQ(denoise("few.%02d.exr", "clean.%02d.exr", "--motion guess").code, 2);
    const std::string explained = run("denoise --explain " + path("few.%02d.exr")).output;
    EXPECT_THAT(explained, HasSubstr(std::string("no motion       ") + searched));
    EXPECT_THAT(explained, HasSubstr("searched motion is found for"));
    const std::string off = run("denoise --explain --motion none " + path("few.%02d.exr")).output;
    EXPECT_THAT(off, HasSubstr("no motion       each frame is denoised alone"));
    EXPECT_THAT(off, Not(HasSubstr("searched")));
    EXPECT_THAT(run("denoise --explain " + path("few.02.exr")).output, Not(HasSubstr("searched")))
        << "one frame";
}

TEST_F(CliShotTest, ExplainSaysWhatItSees) {
    writeAsCycles("cycles.{:02}.exr");
    Result result = run("denoise --explain " + path("cycles.%02d.exr"));
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("layers of Cycles (Blender), 96x54 pixels, 1 part, zip"));
    EXPECT_THAT(result.output, HasSubstr("depth           ViewLayer.Depth.Z (along the camera's axis)"));
    EXPECT_THAT(result.output, HasSubstr("no roughness"));
    EXPECT_THAT(result.output, Not(HasSubstr("not used")));
    EXPECT_THAT(result.output, Not(HasSubstr("is its sign right")));
    result = run("denoise --explain " + path("own.%02d.exr"));
    EXPECT_THAT(result.output, HasSubstr("layers of Limpid"));
    EXPECT_THAT(result.output, HasSubstr("camera: given"));
    EXPECT_EQ(run("denoise --explain " + path("missing.exr")).code, 3);
}

TEST_F(CliShotTest, ShardsAndInterruptedRunsMakeTheSameFiles) {
    ASSERT_EQ(denoise("own.%02d.exr", "whole.%02d.exr").code, 0);
    ASSERT_EQ(denoise("own.%02d.exr", "part.%02d.exr", "--shard 1/2").code, 0);
    EXPECT_TRUE(fs::exists(path("part.03.exr")));
    EXPECT_FALSE(fs::exists(path("part.04.exr")));
    Result result = denoise("own.%02d.exr", "part.%02d.exr", "--resume");
    EXPECT_THAT(result.output, HasSubstr("4 frames were complete"));
    // The run-up covers the whole shot here, so that the files are equal.
    for (const char* frame : {"00", "03", "04", "07"})
        EXPECT_EQ(get(std::string("part.") + frame + ".exr"), get(std::string("whole.") + frame + ".exr"))
            << frame;
    result = denoise("own.%02d.exr", "part.%02d.exr", "--resume");
    EXPECT_THAT(result.output, HasSubstr("8 frames were complete"));
    result = denoise("own.%02d.exr", "part.%02d.exr", "--resume --set svgf.levels=3");
    EXPECT_THAT(result.output, Not(HasSubstr("were complete"))) << "other settings";
    // A changed frame changes those before it if they are denoised backwards, too; a missing one does not.
    ASSERT_EQ(denoise("own.%02d.exr", "both.%02d.exr", "--bidirectional").code, 0);
    ASSERT_EQ(denoise("own.%02d.exr", "few.%02d.exr", "--bidirectional --frames 2-3").code, 0);
    for (const char* frame : {"02", "03"})
        EXPECT_EQ(get(std::string("few.") + frame + ".exr"), get(std::string("both.") + frame + ".exr"))
            << frame;
    fs::remove(path("both.07.exr"));
    result = denoise("own.%02d.exr", "both.%02d.exr", "--bidirectional --resume");
    EXPECT_THAT(result.output, HasSubstr("7 frames were complete"));
    const std::string before = get("own.05.exr");
    fs::copy_file(path("own.04.exr"), path("own.05.exr"), fs::copy_options::overwrite_existing);
    result = denoise("own.%02d.exr", "both.%02d.exr", "--bidirectional --resume");
    EXPECT_THAT(result.output, Not(HasSubstr("were complete")));
    put("own.05.exr", before);
    // Also of some frames, or of a single one.
    EXPECT_EQ(denoise("own.%02d.exr", "few.%02d.exr", "--frames 2-3").code, 0);
    EXPECT_EQ(denoise("own.%02d.exr", "few.%02d.exr", "--frames 7").code, 0);
    for (const char* frame : {"02", "03", "07"})
        EXPECT_EQ(get(std::string("few.") + frame + ".exr"), get(std::string("whole.") + frame + ".exr"))
            << frame;
    for (const char* frame : {"01", "04", "06"})
        EXPECT_FALSE(fs::exists(path(std::string("few.") + frame + ".exr"))) << frame;
    // A single file, and frames that are not there.
    ASSERT_EQ(denoise("own.02.exr", "one.exr", "--resume").code, 0);
    EXPECT_THAT(denoise("own.02.exr", "one.exr", "--resume").output, HasSubstr("1 frames were complete"));
    result = denoise("own.%02d.exr", "few.%02d.exr", "--frames 6-9");
    EXPECT_EQ(result.code, 3);
    EXPECT_THAT(result.output, HasSubstr("frames 8-9 are missing"));
    EXPECT_EQ(denoise("own.%02d.exr", "own.%02d.exr").code, 2) << "in place";
    for (const char* wrong : {"--map beauty=", "--shard 0/2", "--shard 3/2", "--shard 1", "--frames 5-2",
                              "--frames x", "--cuts 1,x", "--on-error never", "--strength 2", "--map albedo",
                              "--bidirectional --denoiser kpcn", "--bidirectional --denoiser bilateral"})
        EXPECT_EQ(denoise("own.%02d.exr", "few.%02d.exr", wrong).code, 2) << wrong;
}

TEST_F(CliShotTest, UnreadableFramesEndTheRunOrAreSkipped) {
    const std::string good = get("own.03.exr");
    put("own.03.exr", good.substr(0, good.size() / 2));
    Result result = denoise("own.%02d.exr", "clean.%02d.exr");
    EXPECT_EQ(result.code, 3) << result.output;
    EXPECT_THAT(result.output, HasSubstr("own.03.exr"));
    EXPECT_TRUE(fs::exists(path("clean.02.exr"))) << "frames before it are complete";
    EXPECT_FALSE(fs::exists(path("clean.03.exr")));
    result = denoise("own.%02d.exr", "clean.%02d.exr", "--on-error skip");
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("the frame is skipped"));
    EXPECT_TRUE(fs::exists(path("clean.07.exr")));
    EXPECT_FALSE(fs::exists(path("clean.03.exr")));
    result = denoise("own.%02d.exr", "clean.%02d.exr", "--on-error skip --resume");
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("7 frames were complete"));
    EXPECT_THAT(result.output, HasSubstr("skipped frames that could not be read: 3"));
    EXPECT_THAT(result.output, HasSubstr(": 0 frames by svgf"));
    // Frames that only make histories.
    result = denoise("own.%02d.exr", "few.%02d.exr", "--frames 5");
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("histories do without the frame"));
    EXPECT_TRUE(fs::exists(path("few.05.exr")));
}

TEST_F(CliShotTest, APartMayHaveNoReadableFrames) {
    for (const char* frame : {"02", "03"}) put(std::string("own.") + frame + ".exr", "damaged");
    fs::remove(path("own.05.exr"));
    Result result = denoise("own.%02d.exr", "clean.%02d.exr", "--on-error skip --window 2");
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("frame 5 is missing"));
    EXPECT_THAT(result.output, HasSubstr("skipped frames that could not be read: 2-3"));
    EXPECT_THAT(result.output, HasSubstr(": 5 frames by svgf"));
    result = denoise("own.%02d.exr", "part.%02d.exr", "--on-error skip --shard 4/7");
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("the frame is skipped"));
    EXPECT_FALSE(fs::exists(path("part.03.exr")));
    for (const char* options : {"--frames 2-3", "--frames 2-3 --window 1", "--frames 2-3 --resume"}) {
        result = denoise("own.%02d.exr", "none.%02d.exr", std::string("--on-error skip ") + options);
        EXPECT_EQ(result.code, 3) << options;
        EXPECT_THAT(result.output, HasSubstr("no frame could be read")) << options;
    }
    result = denoise("own.%02d.exr", "clean.%02d.exr");
    EXPECT_EQ(result.code, 3);
    EXPECT_THAT(result.output, HasSubstr("frame 5 is missing"));
}

TEST_F(CliShotTest, StrengthMixesWithTheInputAndGroupsSumUpToTheBeauty) {
    ASSERT_EQ(denoise("own.02.exr", "clean.exr").code, 0);
    ASSERT_EQ(denoise("own.02.exr", "half.exr", "--strength 0.5").code, 0);
    const auto noisy = colors("own.02.exr"), clean = colors("clean.exr"), half = colors("half.exr");
    for (size_t i = 0; i < half.size(); i += 101)
        EXPECT_NEAR(half[i], (noisy[i] + clean[i]) / 2.0f, 1e-4f + 1e-4f * clean[i]);
    writeAsCycles("cycles.{:02}.exr");
    LayeredImage file = image::readExr(path("cycles.02.exr"));
    Image key = file.get("ViewLayer.Combined", "RGB"), fill = key;
    for (size_t i = 0; i < key.pixels.size(); ++i) {
        const float share = static_cast<float>(i / 3 % width) / width;
        key.pixels[i] *= share;
        fill.pixels[i] *= 1.0f - share;
    }
    file.add("ViewLayer.Combined_key", "RGB", key, Storage::Float);
    file.add("ViewLayer.Combined_fill", "RGB", fill, Storage::Float);
    image::writeExr(path("groups.exr"), file);
    for (const char* method : {"svgf", "nano"}) {
        const Result result = denoise("groups.exr", "groups-clean.exr", std::string("--denoiser ") + method);
        ASSERT_EQ(result.code, 0) << result.output;
        const auto sum = colors("groups-clean.exr", "ViewLayer.Combined");
        const auto a = colors("groups-clean.exr", "ViewLayer.Combined_key");
        const auto b = colors("groups-clean.exr", "ViewLayer.Combined_fill");
        double error = 0.0, total = 0.0;
        for (size_t i = 0; i < sum.size(); ++i) {
            error += std::abs(static_cast<double>(a[i] + b[i] - sum[i]));
            total += static_cast<double>(sum[i]);
        }
        EXPECT_LT(error, 1e-3 * total) << method;
        EXPECT_NE(a, key.pixels) << method;
    }
}

TEST_F(CliShotTest, LayersMayBeFilesOfTheirOwn) {
    const LayeredImage own = image::readExr(path("own.02.exr"));
    const auto putPfm = [&](const std::string& name, const Image& values) {
        std::ofstream file(path(name), std::ios::binary);
        file << "PF\n" << width << " " << height << "\n-1\n";
        for (uint32_t y = height; y-- > 0;)
            file.write(reinterpret_cast<const char*>(&values.pixels[size_t{y} * width * 3]), width * 12);
    };
    putPfm("beauty.02.pfm", own.get("", "RGB"));
    putPfm("albedo.02.pfm", own.get("albedo", "RGB"));
    putPfm("n.02.pfm", own.get("normal", "XYZ"));
    {
        std::ofstream file(path("depth.02.pfm"), std::ios::binary);
        file << "Pf\n" << width << " " << height << "\n-1\n";
        const Image depth = own.get("depth", "Z");
        for (uint32_t y = height; y-- > 0;)
            file.write(reinterpret_cast<const char*>(&depth.pixels[size_t{y} * width]), width * 4);
    }
    const Result all =
        run("denoise --explain " + path("beauty.02.pfm") + " --file depth=" + path("depth.02.pfm"));
    EXPECT_THAT(all.output, HasSubstr("depth           depth.Y"));
    const Result result = denoise("beauty.%02d.pfm", "clean.%02d.exr",
                                  "--file albedo=" + path("albedo.%02d.pfm") +
                                      " --file n=" + path("n.%02d.pfm") + " --map normal=n.RGB");
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_THAT(result.output, Not(HasSubstr("'albedo' is missing")));
    EXPECT_THAT(result.output, HasSubstr("'depth' is missing"));
    const LayeredImage clean = image::readExr(path("clean.02.exr"));
    EXPECT_EQ(clean.channels.size(), 3u) << "only the input's own channels are written";
    EXPECT_LT(meanError(clean.get("", "RGB").pixels, colors("own.02.exr")), 0.5);
    EXPECT_NE(clean.get("", "RGB").pixels, own.get("", "RGB").pixels);
}

/// Two small frames of each shot of scripts/shots, rendered by Blender 3.4.
class CliBlenderTest : public CliTest {
  protected:
    static std::string shot(const std::string& name) {
        return std::string(LIMPID_TEST_DATA) + "/shots/" + name + ".%04d.exr";
    }
};

TEST_F(CliBlenderTest, AllLayersAreUnderstoodUnaided) {
    const std::pair<const char*, const char*> shots[] = {
        {"camera", "62.0"}, {"objects", "55.0"}, {"glass", "50.0"}, {"hair", "46.0"}};
    for (const auto& [name, degrees] : shots) {
        const Result result = run("denoise --explain " + shot(name));
        ASSERT_EQ(result.code, 0) << result.output;
        EXPECT_THAT(result.output, HasSubstr("layers of Cycles (Blender)"));
        EXPECT_THAT(result.output,
                    HasSubstr(fmt::format("camera: from the layers, {} degrees wide", degrees)));
        EXPECT_THAT(result.output, Not(HasSubstr("is its sign right"))) << name;
        EXPECT_THAT(result.output, Not(HasSubstr("is in no layer of light"))) << name;
    }
}

TEST_F(CliBlenderTest, ExplainSaysHowMuchSearchedMotionExplains) {
    const std::string explained = run("denoise --explain " + shot("objects") + " --map motion=").output;
    EXPECT_THAT(explained, HasSubstr("searched motion is found for"));
    EXPECT_THAT(explained, HasSubstr("% of the change between frames 13 and 14"));
    EXPECT_THAT(explained, Not(HasSubstr("is its sign right")));
}

TEST_F(CliBlenderTest, GivenAndFoundCamerasAreTheSame) {
    for (const char* name : {"camera", "glass"}) {
        const std::string cameras = std::string(LIMPID_TEST_DATA) + "/shots/" + name + ".camera.json";
        ASSERT_EQ(run("denoise " + shot(name) + " -o " + path("a.%04d.exr") + " --device cpu").code, 0);
        ASSERT_EQ(
            run("denoise " + shot(name) + " -o " + path("b.%04d.exr") + " --device cpu --camera " + cameras)
                .code,
            0);
        const auto a = image::readExr(path("a.0014.exr")).get("ViewLayer.Combined", "RGB").pixels;
        const auto b = image::readExr(path("b.0014.exr")).get("ViewLayer.Combined", "RGB").pixels;
        EXPECT_LT(meanError(a, b), 2e-3) << name;
        EXPECT_GT(
            meanError(
                a, image::readExr(
                       fmt::format(fmt::runtime(std::string(LIMPID_TEST_DATA) + "/shots/{}.0014.exr"), name))
                       .get("ViewLayer.Combined", "RGB")
                       .pixels),
            0.02);
    }
}

/// A frame of Cycles has no variances, and the network takes it by itself.
TEST_F(CliBlenderTest, TheNetworkCleansFramesWithoutVariances) {
    for (const std::string name : {"camera", "objects", "glass", "hair"}) {
        const std::string in =
            fmt::format(fmt::runtime(std::string(LIMPID_TEST_DATA) + "/shots/{}.0014.exr"), name);
        const Result result =
            run("denoise " + shot(name) + " -o " + path("a.%04d.exr") + " --device cpu --denoiser kpcn");
        ASSERT_EQ(result.code, 0) << result.output;
        EXPECT_THAT(result.output, HasSubstr("variances are estimated from the neighbourhood"));
        ASSERT_EQ(run("denoise " + in + " -o " + path("one.exr") + " --device cpu --denoiser kpcn").code, 0);
        ASSERT_EQ(run("denoise " + shot(name) + " -o " + path("b.%04d.exr") + " --device cpu").code, 0);
        const auto noisy = image::readExr(in).get("ViewLayer.Combined", "RGBA").pixels;
        const auto clean = image::readExr(path("a.0014.exr")).get("ViewLayer.Combined", "RGBA").pixels;
        const auto other = image::readExr(path("b.0014.exr")).get("ViewLayer.Combined", "RGBA").pixels;
        EXPECT_EQ(clean, image::readExr(path("one.exr")).get("ViewLayer.Combined", "RGBA").pixels)
            << name << " has no history";
        for (const float value : clean) ASSERT_TRUE(std::isfinite(value)) << name;
        EXPECT_LT(meanError(clean, other), 0.9 * meanError(noisy, other))
            << name << ": nearer to another method";
    }
    EXPECT_THAT(run("denoise --explain --denoiser kpcn " + shot("glass")).output,
                HasSubstr("variances are estimated from the neighbourhood: no layers are known for those of "
                          "diffuse, specular, albedo, normal, depth"));
    EXPECT_THAT(run("denoise --explain " + shot("glass")).output, Not(HasSubstr("variances are")));
}

/// glTF has y up and Blender's layers z up, and it has no cameras for other frames than it animates.
TEST_F(CliBlenderTest, TheCameraOfAGltfFileIsThatOfTheCamerasFile) {
    const std::string cameras = std::string(LIMPID_TEST_DATA) + "/shots/camera";
    const auto clean = [&](const std::string& options) {
        const Result result =
            run("denoise " + shot("camera") + " -o " + path("a.%04d.exr") + " --device cpu " + options);
        EXPECT_EQ(result.code, 0) << result.output;
        return std::pair(image::readExr(path("a.0014.exr")).get("ViewLayer.Combined", "RGB").pixels,
                         result.output);
    };
    const auto [json, silent] = clean("--camera " + cameras + ".camera.json");
    const auto [gltf, silentToo] = clean("--camera " + cameras + ".glb");
    EXPECT_LT(meanError(json, gltf), 1e-5);
    EXPECT_THAT(silent + silentToo, Not(HasSubstr("has no camera for")));
    const auto [turned, other] = clean("--camera " + cameras + ".glb --map world.up=y --camera-start 10");
    EXPECT_GT(meanError(json, turned), 1e-4);
    const auto [late, warned] = clean("--camera " + cameras + ".glb --fps 12");
    EXPECT_THAT(warned,
                HasSubstr("camera.glb: its animation does not reach frames 13-14; the camera stands still"));
    EXPECT_THAT(run("denoise --explain " + shot("camera") + " --camera " + cameras + ".glb#camera").output,
                HasSubstr("camera: given, 62.0 degrees wide"));
    EXPECT_EQ(run("denoise --explain " + shot("camera") + " --camera " + cameras + ".glb#other").code, 3);
    EXPECT_EQ(run("denoise --explain " + shot("camera") + " --camera " + cameras + ".glb --fps 0").code, 2);
}

TEST_F(CliBlenderTest, OnlyTransparentFilmGetsANewAlpha) {
    for (const char* name : {"hair", "camera"}) {
        const Result result =
            run("denoise " + shot(name) + " -o " + path("a.%04d.exr") + " --device cpu --bidirectional");
        ASSERT_EQ(result.code, 0) << result.output;
        const std::string in = std::string(LIMPID_TEST_DATA) + "/shots/" + name + ".0014.exr";
        image::ExrDocument before = image::ExrDocument::read(in),
                           after = image::ExrDocument::read(path("a.0014.exr"));
        for (const auto& channel : before.parts()[0].channels) {
            const bool color = channel.name.starts_with("ViewLayer.Combined.");
            const bool changes = color && (!channel.name.ends_with(".A") || std::string(name) == "hair");
            EXPECT_EQ(before.values(0, channel.name) == after.values(0, channel.name), !changes)
                << channel.name;
        }
    }
}

/// Two frames that Blender rendered with "Stereoscopy", two views in a file.
TEST_F(CliBlenderTest, EachViewOfAStereoFileIsDenoisedLikeAFileOfItsOwn) {
    const Result explained = run("denoise --explain " + shot("stereo"));
    ASSERT_EQ(explained.code, 0) << explained.output;
    for (const char* view : {"left", "right"})
        EXPECT_THAT(explained.output, HasSubstr(fmt::format("picture 'ViewLayer', view '{}'", view)));
    EXPECT_THAT(explained.output, Not(HasSubstr("not used: ViewLayer.Combined")));
    EXPECT_THAT(explained.output, Not(HasSubstr("is its sign right")));
    ASSERT_EQ(run("denoise " + shot("stereo") + " -o " + path("both.%04d.exr") + " --device cpu").code, 0);
    const auto input = [&](int frame) {
        return fmt::format(fmt::runtime(LIMPID_TEST_DATA "/shots/stereo.{:04}.exr"), frame);
    };
    for (const std::string view : {"left", "right"}) {
        for (const int frame : {13, 14}) {  // a file with this view's channels, named as without views
            const LayeredImage stereo = image::readExr(input(frame));
            LayeredImage one = stereo;
            one.channels.clear();
            for (image::Channel channel : stereo.channels)
                if (const size_t at = channel.name.find("." + view + "."); at != std::string::npos) {
                    channel.name.erase(at, view.size() + 1);
                    one.channels.push_back(std::move(channel));
                }
            image::writeExr(path(fmt::format("{}.{:04}.exr", view, frame)), one);
        }
        ASSERT_EQ(run("denoise " + path(view + ".%04d.exr") + " -o " + path(view + "-clean.%04d.exr") +
                      " --device cpu")
                      .code,
                  0);
        const auto alone =
            image::readExr(path(view + "-clean.0014.exr")).get("ViewLayer.Combined", "RGB").pixels;
        const auto both =
            image::readExr(path("both.0014.exr")).get("ViewLayer.Combined." + view, "RGB").pixels;
        const auto noisy = image::readExr(input(14)).get("ViewLayer.Combined." + view, "RGB").pixels;
        EXPECT_LT(meanError(alone, both), 1e-6) << view;
        EXPECT_GT(meanError(noisy, both), 0.01) << view;
    }
    image::ExrDocument before = image::ExrDocument::read(input(14)),
                       after = image::ExrDocument::read(path("both.0014.exr"));
    ASSERT_EQ(after.parts()[0].channels.size(), before.parts()[0].channels.size());
    EXPECT_EQ(after.parts()[0].views, (std::vector<std::string>{"left", "right"}));
    for (const auto& channel : before.parts()[0].channels)
        EXPECT_EQ(before.values(0, channel.name) == after.values(0, channel.name),
                  !channel.name.starts_with("ViewLayer.Combined.") || channel.name.ends_with(".A"))
            << channel.name;
}

}  // namespace
}  // namespace limpid
