#include "shot/frame/loaded_frame.h"

#include <gmock/gmock.h>

#include "base/error.h"
#include "image/io/exr/exr.h"
#include "image/io/png/png.h"
#include "image/io/temp_folder.h"
#include "shot/frame/clean_picture.h"
#include "shot/layers/shot_fixture.h"

namespace limpid::shot {
namespace {

using image::test::TempFolder;
using test::names;
using testing::HasSubstr;
using testing::IsEmpty;

/// The value of a pixel is that of its channel's last component.
float componentValue(const std::string& channel, uint32_t, uint32_t) {
    const std::string component = channel.substr(channel.rfind('.') + 1);
    return component == "A" ? 1.0f : static_cast<float>(component.front()) / 128.0f;
}

LoadOptions withFile(const std::string& role, const std::filesystem::path& file) {
    LoadOptions options;
    options.files.emplace_back(role, FramePattern(file.string()));
    return options;
}

/// What loading says of a file beside a frame; "none" if nothing.
std::string refusalOf(const std::filesystem::path& frame, const LoadOptions& options) {
    try {
        loadFrame(frame, 0, options);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "none";
}

TEST(LoadedFrame, ContentDecidesTheFormatAndNotTheName) {
    const TempFolder folder;
    for (const char* name : {"a.PNG", "b.exr", "c"}) {
        image::writePng(folder / name, {2, 1, 4, {255, 0, 0, 255, 0, 0, 255, 255}});
        LoadedFrame frame = loadFrame(folder / name, 0, {});
        EXPECT_EQ(frame.file.width(), 2u) << name;
        EXPECT_EQ(frame.file.values(0, "R"), (std::vector<float>{1, 0})) << name;
        EXPECT_EQ(frame.content, contentOf(folder / name, 0, {})) << name;
    }
    image::LayeredImage layers;
    layers.add("", "RGB", image::Image(1, 1, 3, 5.0f), image::Storage::Half);
    image::writeExr(folder / "d.png", layers);
    EXPECT_EQ(loadFrame(folder / "d.png", 0, {}).file.values(0, "G"), std::vector<float>{5});
}

TEST(LoadedFrame, UnknownContentIsRefused) {
    const TempFolder folder;
    image::test::put(folder / "a.png", "nothing known");
    EXPECT_THROW(loadFrame(folder / "a.png", 0, {}), InputError);
}

TEST(LoadedFrame, PicturesForScreensHoldColoursOnly) {
    const TempFolder folder;
    const auto frame =
        test::writeParts(folder / "a.exr", {{.channels = names("R G B")}}, 1, 1, componentValue);
    image::writePng(folder / "a.png", {1, 1, 4, {255, 0, 0, 255}});
    image::test::put(folder / "a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x40\x40\x40\x80");
    const auto png = folder / "a.png", hdr = folder / "a.hdr";
    EXPECT_EQ(refusalOf(frame, withFile("albedo", png)), "none");
    for (const char* role : {"normal", "depth", "motion", "id", "roughness", "alpha"})
        EXPECT_THAT(refusalOf(frame, withFile(role, png)),
                    HasSubstr(std::string(": PNG and JPEG hold colours for screens; '") + role +
                              "' needs EXR or PFM"));
    for (const char* role : {"albedo", "depth", "roughness"})
        EXPECT_EQ(refusalOf(frame, withFile(role, hdr)), "none") << role;
    for (const char* role : {"normal", "motion", "id"})
        EXPECT_THAT(refusalOf(frame, withFile(role, hdr)), HasSubstr("neither signs nor exact numbers"))
            << role;
    LoadOptions mapped = withFile("n", png);
    mapped.assignments = {{"normal", "n.RGB"}};
    EXPECT_THAT(refusalOf(frame, mapped), HasSubstr("--file n="));
}

TEST(LoadedFrame, AllPartsOfAnAttachedFileAreRead) {
    const TempFolder folder;
    const auto frame =
        test::writeParts(folder / "a.exr", {{.channels = names("R G B")}}, 2, 1, componentValue);
    const auto other = test::writeParts(folder / "b.exr",
                                        {{.name = "color", .channels = names("R G B A")},
                                         {.name = "albedo", .channels = names("R G B")},
                                         {.name = "N", .channels = names("X Y Z")}},
                                        2, 1, componentValue);
    const LoadOptions options = withFile("albedo", other);
    LoadedFrame loaded = loadFrame(frame, 0, options);
    ASSERT_EQ(loaded.maps.size(), 1u);
    EXPECT_EQ(loaded.maps[0].find("albedo")->text(), "albedo.albedo.RGB");
    unpack(loaded, options);
    EXPECT_EQ(loaded.layers.at(0).images.at("albedo").at(1, 0, 2), 'B' / 128.0f);
    // None is called "normal", and all have three components.
    EXPECT_THAT(refusalOf(frame, withFile("normal", other)),
                HasSubstr("several of its layers fit (normal.N.XYZ, normal.albedo.XYZ, normal.color.XYZ)"));
    LoadOptions mapped = withFile("normal", other);
    mapped.assignments = {{"normal", "normal.N.XYZ"}};
    EXPECT_EQ(refusalOf(frame, mapped), "none");
}

TEST(LoadedFrame, WhatStaysNoisyIsSaid) {
    const TempFolder folder;
    const auto load = [&](test::TestPart part) {
        test::writeParts(folder / "a.exr", {std::move(part)}, 5, 3, componentValue);
        LoadedFrame frame = loadFrame(folder / "a.exr", 0, {});
        unpack(frame, {});
        return frame;
    };
    EXPECT_THAT(load({.channels = names("R G B")}).warnings, IsEmpty());
    const LoadedFrame overscan = load({.channels = names("R G B"), .overscan = 2});
    EXPECT_EQ(overscan.file.width(), 3u);
    ASSERT_EQ(overscan.warnings.size(), 1u);
    EXPECT_THAT(overscan.warnings[0],
                HasSubstr("a.exr: 6 pixels outside the display window (overscan) stay"));
    const LoadedFrame wide = load({.channels = names("R G B"), .pixelAspect = 2.0f});
    EXPECT_EQ(wide.layers.at(0).pixelAspect, 2.0f);
    EXPECT_THAT(wide.warnings, IsEmpty());
}

TEST(LoadedFrame, PartsOfAnAttachedFileThatAreNotUsedAreNotDecoded) {
    const TempFolder folder;
    constexpr uint32_t side = 32;
    const auto frame =
        test::writeParts(folder / "a.exr", {{.channels = names("R G B")}}, side, side, componentValue);
    const auto other = test::writeParts(folder / "b.exr",
                                        {{.name = "color", .channels = names("R G B A")},
                                         {.name = "albedo", .channels = names("R G B")},
                                         {.name = "N", .channels = names("X Y Z")}},
                                        side, side, componentValue);
    std::string bytes = image::test::get(other);
    bytes.replace(bytes.size() - 8, 8, 8, '\xff');  // the end of the last part's compressed pixels
    image::test::put(other, bytes);
    LoadedFrame loaded = loadFrame(frame, 0, withFile("albedo", other));
    EXPECT_EQ(loaded.maps.at(0).find("albedo")->evaluate(loaded.file).at(9, 9, 2), 'B' / 128.0f);
    const size_t attached = loaded.file.parts().size() - 1;
    EXPECT_THROW(loaded.file.values(attached, "N.X"), Error) << "it was not decoded";
    LoadOptions mapped = withFile("n", other);
    mapped.assignments = {{"normal", "n.N.XYZ"}};
    EXPECT_THROW(loadFrame(frame, 0, mapped), InputError) << "it is damaged";
}

TEST(LoadedFrame, SeveralFilesAreAttachedAndChannelsUsedTwice) {
    const TempFolder folder;
    const auto frame =
        test::writeParts(folder / "a.exr", {{.channels = names("R G B")}}, 2, 1, componentValue);
    const auto colors =
        test::writeParts(folder / "b.exr", {{.channels = names("R G B")}}, 2, 1, componentValue);
    const auto normals =
        test::writeParts(folder / "c.exr", {{.channels = names("X Y Z")}}, 2, 1, componentValue);
    LoadOptions options = withFile("b", colors);
    options.files.emplace_back("normal", FramePattern(normals.string()));
    options.assignments = {{"albedo", "b.RGB"}, {"roughness", "b.G"}};
    LoadedFrame loaded = loadFrame(frame, 0, options);
    const LayerMap& map = loaded.maps.at(0);
    EXPECT_EQ(map.find("albedo")->evaluate(loaded.file).at(1, 0, 1), 'G' / 128.0f);
    EXPECT_EQ(map.find("roughness")->evaluate(loaded.file).at(1, 0, 0), 'G' / 128.0f);
    EXPECT_EQ(map.find("normal")->evaluate(loaded.file).at(1, 0, 2), 'Z' / 128.0f);
}

/// Colours are divided by it, but it is no layer of the frame.
TEST(LoadedFrame, AlphaOfAnotherFileIsReadAndNotWritten) {
    const TempFolder folder;
    const auto frame =
        test::writeParts(folder / "a.exr", {{.channels = names("R G B A")}}, 2, 1, componentValue);
    const auto alpha = test::writeParts(folder / "b.exr", {{.channels = names("Y")}}, 2, 1,
                                        [](const std::string&, uint32_t, uint32_t) { return 0.5f; });
    const LoadOptions options = withFile("alpha", alpha);
    LoadedFrame loaded = loadFrame(frame, 0, options);
    unpack(loaded, options);
    EXPECT_TRUE(loaded.layers.at(0).isTransparent);
    EXPECT_EQ(loaded.maps.at(0).find("alpha")->text(), "alpha.Y");
    EXPECT_FALSE(isReplaceable(loaded.file, *loaded.maps[0].find("alpha")));
    EXPECT_NO_THROW(checkReplaceable(loaded.file, loaded.maps[0]));
}

TEST(LoadedFrame, FilmIsTransparentWhereItsEmptyPixelsAreBlack) {
    const TempFolder folder;
    const auto isTransparent = [&](float sky) {
        const auto value = [&](const std::string& channel, uint32_t x, uint32_t) {
            return x > 0 ? 1.0f : channel == "A" ? 0.0f : sky;
        };
        test::writeParts(folder / "a.exr", {{.channels = names("R G B A")}}, 2, 2, value);
        LoadedFrame frame = loadFrame(folder / "a.exr", 0, {});
        unpack(frame, {});
        return frame.layers.at(0).isTransparent;
    };
    EXPECT_TRUE(isTransparent(0.0f));
    EXPECT_FALSE(isTransparent(0.5f)) << "the sky shows where alpha is 0";
}

TEST(LoadedFrame, FilmIsTransparentIfAThousandthOfThePixelsIs) {
    const TempFolder folder;
    const auto isTransparent = [&](uint32_t holes) {
        const auto value = [&](const std::string& channel, uint32_t x, uint32_t y) {
            return channel == "A" && y == 9 && x < holes ? 0.5f : 1.0f;
        };
        test::writeParts(folder / "a.exr", {{.channels = names("R G B A")}}, 100, 30, value);
        LoadedFrame frame = loadFrame(folder / "a.exr", 0, {});
        unpack(frame, {});
        return frame.layers.at(0).isTransparent;
    };
    EXPECT_FALSE(isTransparent(0));
    EXPECT_FALSE(isTransparent(2));
    EXPECT_TRUE(isTransparent(3));
}

TEST(LoadedFrame, TheCleanNoisyImageOfBlenderBecomesItsCombined) {
    const TempFolder folder;
    std::vector<std::string> channels = names("R G B A", "V.Combined.");
    for (const std::string& name : names("R G B A", "V.Noisy Image.")) channels.push_back(name);
    test::writeParts(folder / "a.exr", {{.channels = channels}}, 1, 1, componentValue);
    LoadedFrame frame = loadFrame(folder / "a.exr", 0, {});
    ASSERT_EQ(frame.warnings.size(), 1u);
    checkReplaceable(frame.file, frame.maps.at(0));
    CleanPicture picture;
    picture.beauty = {5, 6, 7, 1};
    replacePicture(frame.file, frame.maps[0], picture);
    EXPECT_EQ(frame.file.values(0, "V.Combined.G"), std::vector<float>{6});
    EXPECT_EQ(frame.file.values(0, "V.Noisy Image.G"), std::vector<float>{'G' / 128.0f});
}

}  // namespace
}  // namespace limpid::shot
