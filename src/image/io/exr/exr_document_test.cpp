// The input files are written by OpenEXR itself, and outputs are read back by it, in the channels' own types:
// what was not replaced must be equal in every bit.
#include "image/io/exr/exr_document.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "base/error.h"
#include "image/io/exr/exr_files.h"
#include "image/io/temp_folder.h"

namespace limpid::image {
namespace {

using namespace test;

bool losesPrecision(Imf::Compression compression) {
    return compression >= Imf::B44_COMPRESSION;
}

class ExrDocumentCompression : public testing::TestWithParam<const char*> {
  protected:
    Imf::Compression compression() const {
        constexpr std::array names = {"none",  "rle", "zips", "zip",  "piz",
                                      "pxr24", "b44", "b44a", "dwaa", "dwab"};
        const auto found = std::find(names.begin(), names.end(), std::string_view(GetParam()));
        return static_cast<Imf::Compression>(found - names.begin());
    }

    /// Replaces channels of a file with one part, and compares the output with it.
    void check(const Imf::Header& header) {
        const auto input = folder_ / "in.exr", output = folder_ / "out.exr";
        writeSingle(input, header);
        PixelBits want = readParts(input).at(0).pixels;
        ExrDocument document = ExrDocument::read(input);
        EXPECT_EQ(document.parts()[0].compression, GetParam());
        replaceThree(document, 0, want);
        document.setText(0, "limpid.note", "new");
        document.setText(0, "comment", "changed");
        document.write(output);
        expectSamePixels(readParts(output).at(0).pixels, want);

        const RawHeaders before(input), after(output);
        EXPECT_EQ(after.version, before.version);
        ASSERT_EQ(after.parts.size(), 1u);
        Imf::Header expected = before.parts[0];
        expected.insert("limpid.note", Imf::StringAttribute("new"));
        expected.insert("comment", Imf::StringAttribute("changed"));
        if (losesPrecision(header.compression())) expected.compression() = Imf::ZIP_COMPRESSION;
        EXPECT_EQ(attributesOf(after.parts[0]), attributesOf(expected));

        ExrDocument again = ExrDocument::read(output);
        EXPECT_EQ(again.values(0, "Z"), document.values(0, "Z"));
        EXPECT_EQ(again.parts()[0].texts.at("comment"), "changed");
        EXPECT_EQ(again.parts()[0].compression, losesPrecision(header.compression()) ? "zip" : GetParam());
    }

    TempFolder folder_;
};

TEST_P(ExrDocumentCompression, ScanLinesThatWereNotReplacedKeepEveryBit) {
    for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y}) {
        Imf::Header header = makeHeader(compression());
        header.lineOrder() = order;
        addAttributes(header);
        addSharedAttributes(header);
        addPreview(header);
        check(header);
    }
}

TEST_P(ExrDocumentCompression, TilesThatWereNotReplacedKeepEveryBit) {
    for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y, Imf::RANDOM_Y}) {
        Imf::Header header = makeHeader(compression());
        header.lineOrder() = order;
        header.setTileDescription(Imf::TileDescription(16, 12));
        addAttributes(header);
        addSharedAttributes(header);
        addPreview(header);
        check(header);
    }
}

INSTANTIATE_TEST_SUITE_P(All, ExrDocumentCompression,
                         testing::Values("none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa",
                                         "dwab"),
                         [](const auto& each) { return std::string(each.param); });

Imf::Header partHeader(const std::string& name, const std::string& type, Imf::Compression compression,
                       const Box2i& data = frameWindow) {
    Imf::Header header = makeHeader(compression, data);
    header.setName(name);
    header.setType(type);
    addSharedAttributes(header);
    return header;
}

enum Part : size_t { Beauty, Layers, Tiles, Mips, Rips, Deep, DeepTiles, Luma, PartCount };

/// A file with a part of each kind, made once.
class ExrDocumentParts : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        std::vector<Imf::Header> headers(PartCount);
        headers[Beauty] = partHeader("beauty", Imf::SCANLINEIMAGE, Imf::B44_COMPRESSION);
        headers[Beauty].setView("left");
        addAttributes(headers[Beauty]);
        headers[Layers] = partHeader("layers", Imf::SCANLINEIMAGE, Imf::ZIP_COMPRESSION);
        headers[Layers].lineOrder() = Imf::DECREASING_Y;
        addPreview(headers[Layers]);
        headers[Tiles] = partHeader("tiles", Imf::TILEDIMAGE, Imf::PIZ_COMPRESSION);
        headers[Tiles].setTileDescription(Imf::TileDescription(16, 12));
        headers[Tiles].lineOrder() = Imf::RANDOM_Y;
        addPreview(headers[Tiles]);
        headers[Mips] = partHeader("mips", Imf::TILEDIMAGE, Imf::DWAA_COMPRESSION);
        headers[Mips].setTileDescription(Imf::TileDescription(8, 8, Imf::MIPMAP_LEVELS));
        headers[Rips] = partHeader("rips", Imf::TILEDIMAGE, Imf::ZIP_COMPRESSION, {{-3, -2}, {9, 17}});
        headers[Rips].setTileDescription(Imf::TileDescription(8, 8, Imf::RIPMAP_LEVELS, Imf::ROUND_UP));
        headers[Deep] = partHeader("deep", Imf::DEEPSCANLINE, Imf::ZIPS_COMPRESSION, {{-2, 5}, {12, 40}});
        headers[DeepTiles] = partHeader("deep tiles", Imf::DEEPTILE, Imf::RLE_COMPRESSION);
        headers[DeepTiles].setTileDescription(Imf::TileDescription(16, 12));
        headers[Luma] = partHeader("luma", Imf::SCANLINEIMAGE, Imf::PIZ_COMPRESSION, {{-4, 2}, {19, 21}});
        headers[Luma].channels() = {};
        headers[Luma].channels().insert("Y", Imf::Channel(Imf::HALF));
        headers[Luma].channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
        headers[Luma].channels().insert("BY", Imf::Channel(Imf::HALF, 2, 2));
        addAttributes(headers[Luma]);
        folder_ = std::make_unique<TempFolder>();
        writeParts(input(), headers);
        read_ = readParts(input());
    }
    static void TearDownTestSuite() {
        folder_.reset();
        read_.clear();
    }
    static std::filesystem::path input() { return *folder_ / "in.exr"; }
    static std::filesystem::path output() { return *folder_ / "out.exr"; }
    static size_t frameSize() { return size_t{frameWidth} * frameHeight; }

    static inline std::unique_ptr<TempFolder> folder_;
    static inline std::vector<ReadPart> read_;
};

TEST_F(ExrDocumentParts, ChangingOneKeepsTheOthers) {
    for (const std::vector<size_t>& changed :
         std::vector<std::vector<size_t>>{{Beauty}, {Layers}, {Tiles}, {Tiles, Beauty}}) {
        ExrDocument document = ExrDocument::read(input());
        std::vector<ReadPart> want = read_;
        const RawHeaders before(input());
        std::vector<Imf::Header> headers = before.parts;
        for (const size_t part : changed) {
            replaceThree(document, part, want[part].pixels);
            document.setText(part, "limpid.note", "new");
            headers[part].insert("limpid.note", Imf::StringAttribute("new"));
            if (part == Beauty) {
                headers[part].compression() = Imf::ZIP_COMPRESSION;
                headers[part].setChunkCount((frameHeight + 15) / 16);
            }
        }
        document.write(output());
        const std::vector<ReadPart> found = readParts(output());
        const RawHeaders after(output());
        EXPECT_EQ(after.version, before.version);
        ASSERT_EQ(found.size(), PartCount);
        ASSERT_EQ(after.parts.size(), PartCount);
        for (size_t i = 0; i < PartCount; ++i) {
            SCOPED_TRACE(headers[i].name());
            expectSamePixels(found[i].pixels, want[i].pixels);
            EXPECT_EQ(attributesOf(after.parts[i]), attributesOf(headers[i]));
            const bool kept = std::find(changed.begin(), changed.end(), i) == changed.end();
            EXPECT_TRUE(!kept || found[i].blocks == want[i].blocks) << "a block was compressed again";
        }
    }
}

TEST_F(ExrDocumentParts, AreDescribed) {
    ExrDocument document = ExrDocument::read(input());
    EXPECT_EQ(document.name(), input());
    EXPECT_EQ(document.width(), uint32_t{frameWidth});
    EXPECT_EQ(document.height(), uint32_t{frameHeight});
    ASSERT_EQ(document.parts().size(), PartCount);
    const ExrPart& beauty = document.parts()[Beauty];
    EXPECT_EQ(beauty.name, "beauty");
    EXPECT_EQ(beauty.view, "left");
    EXPECT_EQ(beauty.compression, "b44");
    EXPECT_EQ(beauty.unreadable, "");
    EXPECT_EQ(beauty.texts.size(), 3u);
    EXPECT_EQ(beauty.texts.at("comment"), "grüße\nline two");
    EXPECT_EQ(beauty.texts.at("join"), "after the manifest");
    EXPECT_EQ(beauty.numbers.at("exposure"), static_cast<double>(0.1f));
    EXPECT_EQ(beauty.numbers.at("seconds"), 0.1);
    EXPECT_EQ(beauty.numbers.at("frame"), -7.0);
    EXPECT_EQ(beauty.matrices.at("worldToCamera")[7], 8.0f);
    EXPECT_EQ(beauty.matrices.at("precise")[1], 0.1f);
    std::map<std::string, Storage> channels;
    for (const ExrPart::Channel& channel : beauty.channels) channels[channel.name] = channel.storage;
    EXPECT_EQ(channels.size(), 10u);
    EXPECT_EQ(channels.at("R"), Storage::Half);
    EXPECT_EQ(channels.at("normal.Y"), Storage::Float);
    EXPECT_EQ(channels.at("samples"), Storage::Uint);
    EXPECT_EQ(document.parts()[Mips].unreadable, "");
    EXPECT_EQ(document.parts()[Deep].unreadable, "is deep");
    EXPECT_EQ(document.parts()[DeepTiles].unreadable, "is deep");
    EXPECT_EQ(document.parts()[Luma].unreadable, "has the subsampled channel 'BY'");
}

TEST_F(ExrDocumentParts, ThatAreDeepOrSubsampledCannotBeRead) {
    ExrDocument document = ExrDocument::read(input());
    const std::vector<float> values(frameSize());
    for (const auto& [part, channel] : {std::pair{Deep, "R"}, {DeepTiles, "Z"}, {Luma, "Y"}, {Luma, "RY"}}) {
        EXPECT_THROW(document.values(part, channel), InputError) << part;
        EXPECT_THROW(document.replace(part, channel, values), InputError) << part;
    }
    try {
        document.values(Deep, "R");
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("in.exr: the part 'deep' is deep"), std::string::npos)
            << error.what();
    }
}

TEST_F(ExrDocumentParts, WithSeveralLevelsCanBeReadButNotChanged) {
    for (const size_t part : {Mips, Rips}) {
        test::put(output(), "old");
        ExrDocument document = ExrDocument::read(input());
        const std::vector<float> values = document.values(part, "Z");
        EXPECT_TRUE(part != Mips || asFloats(values) == read_[Mips].pixels.at("Z"));
        EXPECT_THROW(
            {
                document.replace(part, "Z", values);
                document.write(output());
            },
            InputError);
        EXPECT_EQ(test::get(output()), "old");
        EXPECT_EQ(folder_->files(), 2u) << "a temporary file is left";
    }
}

TEST_F(ExrDocumentParts, NotReplacedIsAnUnchangedFile) {
    ExrDocument document = ExrDocument::read(input());
    document.values(Layers, "R");
    document.setText(Tiles, "limpid.note", "not worth writing a file");
    document.write(output());
    EXPECT_TRUE(test::get(output()) == test::get(input()));
}

TEST_F(ExrDocumentParts, MayBeWrittenOverTheInput) {
    std::filesystem::copy_file(input(), output(), std::filesystem::copy_options::overwrite_existing);
    ExrDocument document = ExrDocument::read(output());
    std::vector<ReadPart> want = read_;
    replaceThree(document, Layers, want[Layers].pixels);
    document.write(output());
    replaceThree(document, Tiles, want[Tiles].pixels);
    document.write(output());
    const std::vector<ReadPart> found = readParts(output());
    for (size_t i = 0; i < PartCount; ++i) expectSamePixels(found[i].pixels, want[i].pixels);
}

TEST_F(ExrDocumentParts, AskedForWronglyAreErrors) {
    ExrDocument document = ExrDocument::read(input());
    const std::vector<float> values(frameSize());
    for (const char* name : {"", "r", "Rx", "normal", "Y"}) {
        EXPECT_THROW(document.values(Beauty, name), Error) << name;
        EXPECT_THROW(document.replace(Beauty, name, values), Error) << name;
    }
    for (const size_t count : {size_t{0}, frameSize() - 1, frameSize() + 1, 3 * frameSize()})
        EXPECT_THROW(document.replace(Beauty, "R", std::vector<float>(count)), Error) << count;
    EXPECT_THROW(document.setText(Beauty, "exposure", "text"), Error) << "it is a number";
    EXPECT_THROW(document.setText(Beauty, "compression", "text"), Error);
    document.write(output());
    EXPECT_TRUE(test::get(output()) == test::get(input())) << "something was changed";
}

TEST_F(ExrDocumentParts, MissingFilesAndFoldersAreNamed) {
    EXPECT_THROW(ExrDocument::read(*folder_ / "none.exr"), InputError);
    EXPECT_THROW(ExrDocument::read(*folder_ / "."), InputError);
    ExrDocument document = ExrDocument::read(input());
    for (const bool changed : {false, true}) {
        if (changed) document.replace(Tiles, "R", std::vector<float>(frameSize()));
        EXPECT_THROW(document.write(*folder_ / "none" / "out.exr"), OutputError);
        EXPECT_THROW(document.write(input() / "out.exr"), OutputError) << "the folder is a file";
        EXPECT_THROW(document.write(*folder_ / "."), OutputError);
    }
}

TEST_F(ExrDocumentParts, FullDiskIsAnErrorAndKeepsTheOldFile) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");  // OpenEXR's threads do not survive a fork
    test::put(output(), "old");
    writeSingle(*folder_ / "single.exr", makeHeader());
    for (const auto& [path, limit] :
         {std::pair{input(), size_t{100}}, {input(), 20000}, {*folder_ / "single.exr", 4096}}) {
        EXPECT_EXIT(
            {
                ExrDocument document = ExrDocument::read(path);
                document.replace(0, "R", countUp(frameSize()));
                test::limitFileSize(limit);
                bool refused = false;
                try {
                    document.write(output());
                } catch (const OutputError&) {
                    refused = true;
                }
                // This process has its own folder.
                const bool kept = test::get(output()) == "old" && folder_->files() == 3;
                folder_.reset();
                std::_Exit(refused && kept ? 0 : 1);
            },
            testing::ExitedWithCode(0), "");
    }
    std::filesystem::remove(*folder_ / "single.exr");
}

TEST(ExrDocument, PixelsOutsideTheDataWindowAreZeroAndThoseOutsideTheFrameStay) {
    TempFolder folder;
    const Box2i frame({-7, 20}, {12, 33});
    const size_t width = 20, height = 14;
    for (const bool tiled : {false, true}) {
        for (const Box2i& data :
             {Box2i({-3, 22}, {5, 30}), Box2i({-40, -10}, {30, 50}), Box2i({5, 10}, {25, 25}),
              Box2i({-30, 30}, {-7, 33}), Box2i({12, 33}, {12, 33}), Box2i({100, 100}, {110, 103})}) {
            SCOPED_TRACE(testing::Message() << data.min.x << " " << data.min.y);
            Imf::Header header = makeHeader(Imf::PIZ_COMPRESSION, data);
            header.displayWindow() = frame;
            if (tiled) header.setTileDescription(Imf::TileDescription(8, 16));
            writeSingle(folder / "in.exr", header);
            const PixelBits before = readParts(folder / "in.exr").at(0).pixels;
            ExrDocument document = ExrDocument::read(folder / "in.exr");
            ASSERT_EQ(document.width(), width);
            ASSERT_EQ(document.height(), height);
            PixelBits want = before;
            std::vector<float> inside(width * height);
            const std::vector<float> replaced = countUp(width * height, 7);
            const auto dataWidth = static_cast<size_t>(data.max.x - data.min.x) + 1;
            for (size_t i = 0; i < inside.size(); ++i) {
                const V2i pixel = frame.min + V2i(static_cast<int>(i % width), static_cast<int>(i / width));
                if (!data.intersects(pixel)) continue;
                const V2i at = pixel - data.min;
                const size_t offset = (static_cast<size_t>(at.y) * dataWidth + static_cast<size_t>(at.x)) * 4;
                uint32_t id = 0;
                std::memcpy(&id, before.at("id").data() + offset, 4);
                inside[i] = static_cast<float>(id);
                want["id"].replace(offset, 4, asUints({replaced[i]}));
                want["Z"].replace(offset, 4, asFloats({replaced[i]}));
            }
            EXPECT_EQ(document.values(0, "id"), inside);
            document.replace(0, "id", replaced);
            document.replace(0, "Z", replaced);
            document.write(folder / "out.exr");
            expectSamePixels(readParts(folder / "out.exr").at(0).pixels, want);
            EXPECT_EQ(attributesOf(RawHeaders(folder / "out.exr").parts[0]),
                      attributesOf(RawHeaders(folder / "in.exr").parts[0]));
        }
    }
}

TEST(ExrDocument, CountsPixelsOutsideTheFrame) {
    TempFolder folder;
    const auto outside = [&](const Box2i& data) {
        writeSingle(folder / "a.exr", makeHeader(Imf::ZIP_COMPRESSION, data));
        const ExrDocument document = ExrDocument::read(folder / "a.exr");
        EXPECT_EQ(document.pixelAspect(), 1.5f);
        return document.pixelsOutside(0);
    };
    EXPECT_EQ(outside(frameWindow), 0u);
    EXPECT_EQ(outside({{3, 4}, {5, 6}}), 0u) << "a crop";
    EXPECT_EQ(outside({{-2, -1}, {frameWidth, frameHeight - 1}}),
              uint64_t{(frameWidth + 3) * (frameHeight + 1) - frameWidth * frameHeight});
    EXPECT_EQ(outside({{-2, 0}, {0, 0}}), 2u);
    EXPECT_EQ(outside({{100, 100}, {103, 100}}), 4u) << "nothing is inside";
}

TEST(ExrDocument, ConvertsToAndFromTheTypeOfEachChannel) {
    TempFolder folder;
    Imf::Header header(6, 1);
    for (const auto& [name, type] : {std::pair{"h", Imf::HALF}, {"f", Imf::FLOAT}, {"u", Imf::UINT}})
        header.channels().insert(name, Imf::Channel(type));
    writeSingle(folder / "a.exr", header);
    ExrDocument document = ExrDocument::read(folder / "a.exr");
    const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf("");
    const std::vector<float> values = {-2.6f, 2.6f, 1e20f, inf, -0.0f, 0.1f};
    for (const char* name : {"h", "f", "u"}) document.replace(0, name, values);
    document.write(folder / "a.exr");
    document = ExrDocument::read(folder / "a.exr");
    EXPECT_EQ(document.values(0, "f"), values);
    EXPECT_EQ(document.decodedBytes(0), 6u * (2 + 4 + 4));
    std::vector<float> pairs(12, 7.0f);
    document.read(0, "f", std::span(pairs).subspan(1), 2);
    for (size_t p = 0; p < 6; ++p) {
        EXPECT_EQ(pairs[2 * p], 7.0f);
        EXPECT_EQ(pairs[2 * p + 1], values[p]);
    }
    EXPECT_THROW(document.read(0, "f", std::span(pairs).first(10), 2), Error);
    EXPECT_EQ(document.values(0, "h"),
              (std::vector<float>{half(-2.6f), half(2.6f), 65504.0f, inf, -0.0f, half(0.1f)}));
    EXPECT_TRUE(std::signbit(document.values(0, "h")[4]));
    constexpr float most = 4294967296.0f;  // 2^32 - 1, rounded
    EXPECT_EQ(document.values(0, "u"), (std::vector<float>{0.0f, 3.0f, most, most, 0.0f, 0.0f}));
    for (const char* name : {"h", "f", "u"}) document.replace(0, name, std::vector<float>(6, nan));
    EXPECT_TRUE(std::isnan(document.values(0, "h")[0]));
    EXPECT_TRUE(std::isnan(document.values(0, "f")[0]));
    EXPECT_EQ(document.values(0, "u")[0], 0.0f);
}

TEST(ExrDocument, AFileWithOnePartThatWasNotReplacedIsUnchanged) {
    TempFolder folder;
    for (const bool tiled : {false, true}) {
        Imf::Header header = makeHeader(Imf::DWAB_COMPRESSION);
        if (tiled) header.setTileDescription(Imf::TileDescription(8, 8, Imf::MIPMAP_LEVELS));
        writeSingle(folder / "in.exr", header);
        ExrDocument document = ExrDocument::read(folder / "in.exr");
        document.values(0, "R");
        document.setText(0, "limpid.note", "not worth writing a file");
        document.write(folder / "out.exr");
        EXPECT_TRUE(test::get(folder / "out.exr") == test::get(folder / "in.exr"));
    }
}

TEST(ExrDocument, AttributesThatBelongToOtherKindsOfFilesAreLeftOut) {
    // Programs that turn tiled files into others, or separate parts, leave them in the header.
    TempFolder folder;
    Imf::Header header = makeHeader(Imf::B44_COMPRESSION);
    header.setTileDescription(Imf::TileDescription(16, 12, Imf::MIPMAP_LEVELS));
    header.setChunkCount(1);
    header.setName("beauty");
    header.setType(Imf::SCANLINEIMAGE);
    fillRows(Imf::OutputFile((folder / "in.exr").c_str(), header), header, 1);
    std::string bytes = test::get(folder / "in.exr");
    bytes[5] = static_cast<char>(bytes[5] & ~2);  // the flag of tiled files, which OpenEXR sets
    test::put(folder / "in.exr", bytes);
    const RawHeaders before(folder / "in.exr");
    std::map<std::string, std::string> expected = attributesOf(before.parts[0]);
    EXPECT_EQ(expected.erase("tiles") + expected.erase("chunkCount"), 2u);
    expected["compression"].back() = Imf::ZIP_COMPRESSION;

    PixelBits want = readParts(folder / "in.exr").at(0).pixels;
    ExrDocument document = ExrDocument::read(folder / "in.exr");
    EXPECT_EQ(document.parts()[0].name, "beauty");
    replaceThree(document, 0, want);
    document.write(folder / "out.exr");
    const RawHeaders after(folder / "out.exr");
    EXPECT_EQ(after.version, before.version);
    EXPECT_EQ(attributesOf(after.parts[0]), expected);
    expectSamePixels(readParts(folder / "out.exr").at(0).pixels, want);
}

}  // namespace
}  // namespace limpid::image
