#include "image/io/exr/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfTileDescription.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/error.h"
#include "image/io/temp_folder.h"

namespace limpid::image {
namespace {

using test::TempFolder;

LayeredImage makeLayers(uint32_t width, uint32_t height) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-4.0f, 1000.0f);
    Image color(width, height, 3), depth(width, height, 1), id(width, height, 1);
    for (float& v : color.pixels) v = uniform(random);
    for (float& v : depth.pixels) v = uniform(random);
    for (float& v : id.pixels) v = static_cast<float>(random() % (1u << 24));
    LayeredImage image;
    image.add("", "RGB", color, Storage::Half);
    image.add("depth", "Z", depth, Storage::Float);
    image.add("id", "I", id, Storage::Uint);
    image.metadata = {{"limpid.samples", "16"}, {"limpid.note", "grüße\nline two"}, {"empty", ""}};
    return image;
}

/// A file written by the library itself, with the value 100 y + x at every pixel of the data window.
struct Foreign {
    Imath::Box2i display{{0, 0}, {9, 7}};
    Imath::Box2i data{{0, 0}, {9, 7}};
    std::vector<std::string> names = {"R", "G", "B"};
    Imf::LineOrder order = Imf::INCREASING_Y;

    Imf::Header header() const {
        Imf::Header h(display, data);
        h.lineOrder() = order;
        for (const std::string& name : names) h.channels().insert(name, Imf::Channel(Imf::FLOAT));
        return h;
    }
    std::vector<float> pixels() const {
        std::vector<float> values;
        for (int y = data.min.y; y <= data.max.y; ++y) {
            for (int x = data.min.x; x <= data.max.x; ++x) values.push_back(static_cast<float>(100 * y + x));
        }
        return values;
    }
    Imf::FrameBuffer frame(std::vector<float>& values) const {
        const auto width = static_cast<size_t>(data.max.x - data.min.x + 1);
        Imf::FrameBuffer f;
        for (const std::string& name : names) {
            f.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), data, 4, 4 * width));
        }
        return f;
    }
    void write(const std::filesystem::path& path) const {
        std::vector<float> values = pixels();
        Imf::OutputFile file(path.c_str(), header());
        file.setFrameBuffer(frame(values));
        const int rows = data.max.y - data.min.y + 1;
        file.writePixels(rows);
    }
};

TEST(Exr, EveryStorageLayerAndStringComesBack) {
    TempFolder folder;
    const LayeredImage image = makeLayers(37, 29);
    for (const Compression compression :
         {Compression::None, Compression::Rle, Compression::Zips, Compression::Zip, Compression::Piz}) {
        writeExr(folder / "a.exr", image, compression);
        const LayeredImage back = readExr(folder / "a.exr");
        ASSERT_EQ(back.width, 37u);
        ASSERT_EQ(back.height, 29u);
        EXPECT_EQ(back.metadata, image.metadata);
        ASSERT_EQ(back.channels.size(), 5u);
        for (const Channel& channel : image.channels) {
            const Channel* found = back.find(channel.name);
            ASSERT_NE(found, nullptr) << channel.name;
            EXPECT_EQ(found->storage, channel.storage);
            for (size_t i = 0; i < channel.values.size(); ++i) {
                const float want = channel.values[i];
                const float tolerance =
                    channel.storage == Storage::Half ? std::abs(want) / 2048.0f + 1e-7f : 0.0f;
                ASSERT_NEAR(found->values[i], want, tolerance) << channel.name << " " << i;
            }
        }
    }
}

TEST(Exr, HalfKeepsBrightPixelsFiniteAndOthersAsTheyAre) {
    TempFolder folder;
    const float inf = std::numeric_limits<float>::infinity();
    Image image(4, 1, 1);
    image.pixels = {1e9f, -1e9f, inf, std::nanf("")};
    LayeredImage layers;
    layers.add("", "Y", image, Storage::Half);
    writeExr(folder / "a.exr", layers);
    const std::vector<float> back = readExr(folder / "a.exr").find("Y")->values;
    EXPECT_EQ(back[0], 65504.0f);
    EXPECT_EQ(back[1], -65504.0f);
    EXPECT_EQ(back[2], inf);
    EXPECT_TRUE(std::isnan(back[3]));
}

TEST(Exr, UintClampsWhatItCannotHold) {
    TempFolder folder;
    Image image(4, 1, 1);
    image.pixels = {-3.0f, 1e20f, std::nanf(""), 16777215.0f};
    LayeredImage layers;
    layers.add("id", "I", image, Storage::Uint);
    writeExr(folder / "a.exr", layers);
    const std::vector<float> back = readExr(folder / "a.exr").find("id.I")->values;
    EXPECT_EQ(back, (std::vector<float>{0.0f, 4294967296.0f, 0.0f, 16777215.0f}));
}

TEST(Exr, RefusesContentThatMakesNoFileAndKeepsTheOldOne) {
    TempFolder folder;
    const auto path = folder / "a.exr";
    test::put(path, "old");
    LayeredImage image = makeLayers(4, 4);
    image.channels[1].name = "R";
    EXPECT_THROW(writeExr(path, image), Error) << "a name twice";
    image = makeLayers(4, 4);
    image.channels[0].values.pop_back();
    EXPECT_THROW(writeExr(path, image), Error) << "too few values";
    image = makeLayers(4, 4);
    image.metadata["compression"] = "mine";
    EXPECT_THROW(writeExr(path, image), Error) << "a reserved attribute";
    EXPECT_THROW(writeExr(path, LayeredImage{}), Error);
    EXPECT_EQ(test::get(path), "old");
    EXPECT_EQ(folder.files(), 1u);
    EXPECT_THROW(writeExr(folder / "none" / "a.exr", makeLayers(2, 2)), OutputError);
}

TEST(Exr, FullDiskIsAnErrorAndKeepsTheOldFile) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");  // OpenEXR's threads do not survive a fork
    // A limit on the file's size fails the same way as a full disk: the write itself reports it.
    TempFolder folder;
    const auto path = folder / "a.exr";
    test::put(path, "old");
    EXPECT_EXIT(
        {
            test::limitFileSize(4096);
            try {
                writeExr(path, makeLayers(64, 64));
            } catch (const OutputError&) {
                std::_Exit(0);
            }
            std::_Exit(1);
        },
        testing::ExitedWithCode(0), "");
    EXPECT_EQ(test::get(path), "old");
    EXPECT_EQ(folder.files(), 1u);
}

TEST(Exr, ReadsEitherLineOrder) {
    TempFolder folder;
    Foreign foreign;
    foreign.data = foreign.display = {{0, 0}, {9, 599}};  // more rows than one band
    for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y}) {
        foreign.order = order;
        foreign.write(folder / "a.exr");
        const LayeredImage image = readExr(folder / "a.exr");
        EXPECT_EQ(image.find("G")->values, foreign.pixels());
    }
}

TEST(Exr, ReadsTheNamesThatBlenderWrites) {
    TempFolder folder;
    Foreign foreign;
    foreign.names = {
        "ViewLayer.Combined.A",         "ViewLayer.Combined.B",        "ViewLayer.Combined.G",
        "ViewLayer.Combined.R",         "ViewLayer.Depth.Z",           "ViewLayer.Denoising Albedo.R",
        "ViewLayer.Denoising Albedo.G", "ViewLayer.Denoising Albedo.B"};
    foreign.write(folder / "a.exr");
    const LayeredImage image = readExr(folder / "a.exr");
    EXPECT_EQ(image.channels.size(), 8u);
    EXPECT_EQ(image.colorLayer(), "ViewLayer.Combined");
    EXPECT_EQ(image.get("ViewLayer.Combined", "RGBA").at(3, 2, 0), 203.0f);
    EXPECT_THROW(image.get("", "RGB"), Error);
}

TEST(Exr, ACropLiesInItsFrameAndOverscanIsLeftOut) {
    TempFolder folder;
    Foreign foreign;
    foreign.display = {{10, 20}, {19, 27}};
    for (const Imath::Box2i& data :
         {Imath::Box2i{{12, 22}, {15, 24}}, Imath::Box2i{{-5, -400}, {30, 300}},
          Imath::Box2i{{15, 10}, {25, 22}}, Imath::Box2i{{100, 100}, {101, 101}}}) {
        foreign.data = data;
        foreign.write(folder / "a.exr");
        const LayeredImage image = readExr(folder / "a.exr");
        ASSERT_EQ(image.width, 10u);
        ASSERT_EQ(image.height, 8u);
        for (int y = 20; y <= 27; ++y) {
            for (int x = 10; x <= 19; ++x) {
                const float want = data.intersects(Imath::V2i(x, y)) ? static_cast<float>(100 * y + x) : 0.0f;
                ASSERT_EQ(image.find("R")->values[static_cast<size_t>((y - 20) * 10 + x - 10)], want)
                    << x << " " << y;
            }
        }
    }
}

TEST(Exr, ReadsTiledFiles) {
    TempFolder folder;
    Foreign foreign;
    foreign.data = foreign.display = {{0, 0}, {69, 330}};
    for (const Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS}) {
        Imf::Header header = foreign.header();
        header.setTileDescription(Imf::TileDescription(32, 24, mode));
        std::vector<float> values = foreign.pixels();
        {
            Imf::TiledOutputFile file((folder / "a.exr").c_str(), header);
            file.setFrameBuffer(foreign.frame(values));
            for (int level = 0; level < file.numLevels(); ++level) {
                file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
            }
        }
        EXPECT_EQ(readExr(folder / "a.exr").find("R")->values, values);
    }
}

TEST(Exr, ReadsTheFirstPartOfSeveral) {
    TempFolder folder;
    Foreign first, second;
    second.data = second.display = {{0, 0}, {3, 3}};
    second.names = {"other"};
    std::vector<Imf::Header> headers = {first.header(), second.header()};
    for (size_t i = 0; i < 2; ++i) {
        headers[i].setName(i == 0 ? "left" : "right");
        headers[i].setType(Imf::SCANLINEIMAGE);
    }
    {
        std::vector<float> values[2] = {first.pixels(), second.pixels()};
        Imf::MultiPartOutputFile file((folder / "a.exr").c_str(), headers.data(), 2, true);
        Imf::OutputPart a(file, 0), b(file, 1);
        a.setFrameBuffer(first.frame(values[0]));
        a.writePixels(8);
        b.setFrameBuffer(second.frame(values[1]));
        b.writePixels(4);
    }
    const LayeredImage image = readExr(folder / "a.exr");
    EXPECT_EQ(image.find("B")->values, first.pixels());
    EXPECT_EQ(image.find("other"), nullptr);
    EXPECT_TRUE(image.metadata.empty()) << "a part's name and type are no metadata";
}

TEST(Exr, RefusesSubsampledChannels) {
    TempFolder folder;
    Imf::Header header(8, 8);
    header.channels().insert("BY", Imf::Channel(Imf::HALF, 2, 2));
    { Imf::OutputFile file((folder / "a.exr").c_str(), header); }
    try {
        readExr(folder / "a.exr");
        FAIL() << "it was read";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("subsampled"), std::string::npos) << error.what();
    }
}

TEST(LayeredImageTest, AddsAndGetsLayers) {
    Image image(2, 1, 3);
    image.pixels = {1, 2, 3, 4, 5, 6};
    LayeredImage layers;
    layers.add("normal", "XYZ", image, Storage::Half);
    EXPECT_EQ(layers.get("normal", "ZX").pixels, (std::vector<float>{3, 1, 6, 4}));
    EXPECT_THROW(layers.add("normal", "X", image, Storage::Half), Error);
    EXPECT_THROW(layers.add("big", "X", Image(3, 1, 1), Storage::Half), Error);
    EXPECT_THROW(layers.add("wide", "WXYZ", image, Storage::Half), Error);
    EXPECT_EQ(layers.colorLayer(), std::nullopt);
    layers.add("albedo", "RGB", image, Storage::Half);
    EXPECT_EQ(layers.colorLayer(), "albedo");
    layers.add("", "RGB", image, Storage::Half);
    EXPECT_EQ(layers.colorLayer(), "");
}

}  // namespace
}  // namespace limpid::image
