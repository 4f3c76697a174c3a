// The input files are written by OpenEXR itself, and outputs are read back by it, in the channels' own types:
// what was not replaced must be equal in every bit.
#include "image/io/exr/exr_document.h"

#include <ImfBoxAttribute.h>
#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineInputPart.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfDeepTiledInputPart.h>
#include <ImfDeepTiledOutputPart.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfIDManifest.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOpaqueAttribute.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfPreviewImage.h>
#include <ImfRationalAttribute.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <ImfTileDescription.h>
#include <ImfTiledInputPart.h>
#include <ImfTiledOutputFile.h>
#include <ImfTiledOutputPart.h>
#include <ImfVecAttribute.h>
#include <ImfVersion.h>
#include <ImfXdr.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "base/error.h"
#include "image/io/exr/exr_header.h"
#include "image/io/temp_folder.h"

namespace limpid::image {
namespace {

using Imath::Box2i;
using Imath::V2i;
using test::TempFolder;

/// A channel's pixels in its own type, by name; of levels other than the first with their numbers: "R 1 1".
using PixelBits = std::map<std::string, std::string>;

size_t bytesOf(Imf::PixelType type) {
    return type == Imf::HALF ? 2 : 4;
}

template <typename T>
std::string rawBytes(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// Returns the bits of any value, every third of which conversions or compressions may change: signalling and
/// other NaNs, infinities, -0, denormals, the largest.
std::string oddBits(Imf::PixelType type, std::mt19937& random) {
    constexpr std::array<uint16_t, 8> halves = {0x7c01, 0xfe37, 0x7c00, 0xfc00,
                                                0x8000, 0x0001, 0x83ff, 0x7bff};
    constexpr std::array<uint32_t, 8> floats = {0x7f800001, 0xffc12345, 0x7f800000, 0xff800000,
                                                0x80000000, 0x00000001, 0x807fffff, 0x7f7fffff};
    const auto bits = static_cast<uint32_t>(random());
    const bool odd = bits % 3 == 0;
    if (type == Imf::HALF) return rawBytes(odd ? halves[bits % 8] : static_cast<uint16_t>(bits >> 8));
    return rawBytes(odd && type == Imf::FLOAT ? floats[bits % 8] : bits);
}

/// The pixels of one level of a part, to be written or read.
class FlatMemory {
  public:
    FlatMemory(const Imf::ChannelList& channels, const Box2i& window) {
        for (auto it = channels.begin(); it != channels.end(); ++it) {
            const Imf::Channel& channel = it.channel();
            const size_t size = bytesOf(channel.type);
            const auto width = static_cast<size_t>((window.max.x - window.min.x) / channel.xSampling + 1);
            const auto height = static_cast<size_t>((window.max.y - window.min.y) / channel.ySampling + 1);
            std::string& plane = planes_[it.name()];
            plane.resize(width * height * size);
            types_[it.name()] = channel.type;
            frame_.insert(it.name(), Imf::Slice::Make(channel.type, plane.data(), window, size, size * width,
                                                      channel.xSampling, channel.ySampling));
        }
    }
    void fill(uint32_t seed) {
        std::mt19937 random(seed);
        for (auto& [name, plane] : planes_) {
            const size_t size = bytesOf(types_[name]);
            for (size_t at = 0; at < plane.size(); at += size)
                plane.replace(at, size, oddBits(types_[name], random));
        }
    }
    const Imf::FrameBuffer& frame() const { return frame_; }
    const PixelBits& bits() const { return planes_; }

  private:
    PixelBits planes_;
    std::map<std::string, Imf::PixelType> types_;
    Imf::FrameBuffer frame_;
};

/// The samples of a deep part.
class DeepMemory {
  public:
    DeepMemory(const Imf::ChannelList& channels, const Box2i& window)
        : window_(window), width_(static_cast<size_t>(window.max.x - window.min.x) + 1) {
        counts_.resize(width_ * (static_cast<size_t>(window.max.y - window.min.y) + 1));
        for (auto it = channels.begin(); it != channels.end(); ++it)
            channels_[it.name()] = {it.channel().type, {}, std::vector<char*>(counts_.size())};
    }
    void fill(uint32_t seed) {
        std::mt19937 random(seed);
        for (uint32_t& count : counts_) count = static_cast<uint32_t>(random() % 4);
        allocate();
        for (auto& [name, channel] : channels_) {
            const size_t size = bytesOf(channel.type);
            for (std::string& samples : channel.samples) {
                for (size_t at = 0; at < samples.size(); at += size)
                    samples.replace(at, size, oddBits(channel.type, random));
            }
        }
    }
    /// Makes room for as many samples as were counted.
    void allocate() {
        for (auto& [name, channel] : channels_) {
            channel.samples.resize(counts_.size());
            for (size_t i = 0; i < counts_.size(); ++i) {
                channel.samples[i].resize(counts_[i] * bytesOf(channel.type));
                channel.pointers[i] = channel.samples[i].data();
            }
        }
    }
    Imf::DeepFrameBuffer frame() {
        const auto origin = [&](auto* first) {
            return reinterpret_cast<char*>(first - window_.min.x -
                                           static_cast<ptrdiff_t>(width_) * window_.min.y);
        };
        Imf::DeepFrameBuffer frame;
        frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, origin(counts_.data()), 4, 4 * width_));
        for (auto& [name, channel] : channels_) {
            frame.insert(name, Imf::DeepSlice(channel.type, origin(channel.pointers.data()), sizeof(char*),
                                              sizeof(char*) * width_, bytesOf(channel.type)));
        }
        return frame;
    }
    PixelBits bits() const {
        PixelBits all;
        for (const uint32_t count : counts_) all["number of samples"] += rawBytes(count);
        for (const auto& [name, channel] : channels_) {
            for (const std::string& samples : channel.samples) all[name] += samples;
        }
        return all;
    }

  private:
    struct Samples {
        Imf::PixelType type;
        std::vector<std::string> samples;  ///< of each pixel
        std::vector<char*> pointers;
    };
    Box2i window_;
    size_t width_;
    std::vector<uint32_t> counts_;
    std::map<std::string, Samples> channels_;
};

int rowsOf(const Imf::Header& header) {
    return header.dataWindow().max.y - header.dataWindow().min.y + 1;
}

/// Calls action(lx, ly) for each level of a tiled file.
template <typename Tiled, typename Action>
void forLevels(const Tiled& file, Action action) {
    for (int ly = 0; ly < file.numYLevels(); ++ly) {
        for (int lx = 0; lx < file.numXLevels(); ++lx) {
            if (file.isValidLevel(lx, ly)) action(lx, ly);
        }
    }
}

void fillRows(auto&& target, const Imf::Header& header, uint32_t seed) {
    FlatMemory memory(header.channels(), header.dataWindow());
    memory.fill(seed);
    target.setFrameBuffer(memory.frame());
    target.writePixels(rowsOf(header));
}

void fillTiles(auto&& target, const Imf::Header& header, uint32_t seed) {
    forLevels(target, [&](int lx, int ly) {
        FlatMemory memory(header.channels(), target.dataWindowForLevel(lx, ly));
        memory.fill(seed++);
        target.setFrameBuffer(memory.frame());
        target.writeTiles(0, target.numXTiles(lx) - 1, 0, target.numYTiles(ly) - 1, lx, ly);
    });
}

/// Writes a file with one part, tiled if the header has a description of tiles.
void writeSingle(const std::filesystem::path& path, const Imf::Header& header, uint32_t seed = 5) {
    if (header.hasTileDescription())
        fillTiles(Imf::TiledOutputFile(path.c_str(), header), header, seed);
    else
        fillRows(Imf::OutputFile(path.c_str(), header), header, seed);
}

void writeParts(const std::filesystem::path& path, const std::vector<Imf::Header>& headers) {
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
    for (int i = 0; i < file.parts(); ++i) {
        const Imf::Header& header = headers[static_cast<size_t>(i)];
        const auto seed = static_cast<uint32_t>(100 * i);
        DeepMemory deep(header.channels(), header.dataWindow());
        deep.fill(seed);
        if (header.type() == Imf::SCANLINEIMAGE) fillRows(Imf::OutputPart(file, i), header, seed);
        if (header.type() == Imf::TILEDIMAGE) fillTiles(Imf::TiledOutputPart(file, i), header, seed);
        if (header.type() == Imf::DEEPSCANLINE) {
            Imf::DeepScanLineOutputPart part(file, i);
            part.setFrameBuffer(deep.frame());
            part.writePixels(rowsOf(header));
        }
        if (header.type() == Imf::DEEPTILE) {
            Imf::DeepTiledOutputPart part(file, i);
            part.setFrameBuffer(deep.frame());
            part.writeTiles(0, part.numXTiles(0) - 1, 0, part.numYTiles(0) - 1);
        }
    }
}

/// A part as OpenEXR reads it.
struct ReadPart {
    PixelBits pixels;
    std::string blocks;  ///< all compressed blocks; empty if deep
};

ReadPart readRows(Imf::InputPart part) {
    const Box2i window = part.header().dataWindow();
    FlatMemory memory(part.header().channels(), window);
    part.setFrameBuffer(memory.frame());
    part.readPixels(window.min.y, window.max.y);
    ReadPart result{memory.bits(), {}};
    for (int y = window.min.y; y <= window.max.y; ++y) {
        const char* data = nullptr;
        int size = 0;
        part.rawPixelData(y, data, size);
        result.blocks.append(data, static_cast<size_t>(size));
    }
    return result;
}

ReadPart readTiles(Imf::TiledInputPart part) {
    ReadPart result;
    forLevels(part, [&](int lx, int ly) {
        FlatMemory memory(part.header().channels(), part.dataWindowForLevel(lx, ly));
        part.setFrameBuffer(memory.frame());
        part.readTiles(0, part.numXTiles(lx) - 1, 0, part.numYTiles(ly) - 1, lx, ly);
        const std::string level = lx + ly == 0 ? "" : " " + std::to_string(lx) + " " + std::to_string(ly);
        for (const auto& [name, bits] : memory.bits()) result.pixels[name + level] = bits;
        // In files with one part, this reads the next tile, not that one.
        const bool random = Imf::isMultiPart(part.version());
        for (int i = 0; random && i < part.numXTiles(lx) * part.numYTiles(ly); ++i) {
            int x = i % part.numXTiles(lx), y = i / part.numXTiles(lx), levelX = lx, levelY = ly, size = 0;
            const char* data = nullptr;
            part.rawTileData(x, y, levelX, levelY, data, size);
            result.blocks.append(data, static_cast<size_t>(size));
        }
    });
    return result;
}

ReadPart readDeep(Imf::DeepScanLineInputPart part) {
    const Box2i window = part.header().dataWindow();
    DeepMemory memory(part.header().channels(), window);
    part.setFrameBuffer(memory.frame());
    part.readPixelSampleCounts(window.min.y, window.max.y);
    memory.allocate();
    part.readPixels(window.min.y, window.max.y);
    return {memory.bits(), {}};
}

ReadPart readDeepTiles(Imf::DeepTiledInputPart part) {
    DeepMemory memory(part.header().channels(), part.header().dataWindow());
    part.setFrameBuffer(memory.frame());
    part.readPixelSampleCounts(0, part.numXTiles(0) - 1, 0, part.numYTiles(0) - 1);
    memory.allocate();
    part.readTiles(0, part.numXTiles(0) - 1, 0, part.numYTiles(0) - 1);
    return {memory.bits(), {}};
}

std::vector<ReadPart> readParts(const std::filesystem::path& path) {
    Imf::MultiPartInputFile file(path.c_str());
    std::vector<ReadPart> parts;
    for (int i = 0; i < file.parts(); ++i) {
        const std::string type = file.header(i).type();
        if (type == Imf::SCANLINEIMAGE) parts.push_back(readRows({file, i}));
        if (type == Imf::TILEDIMAGE) parts.push_back(readTiles({file, i}));
        if (type == Imf::DEEPSCANLINE) parts.push_back(readDeep({file, i}));
        if (type == Imf::DEEPTILE) parts.push_back(readDeepTiles({file, i}));
    }
    return parts;
}

void expectSamePixels(const PixelBits& found, const PixelBits& want) {
    EXPECT_EQ(found.size(), want.size());
    for (const auto& [name, bits] : want) {
        ASSERT_TRUE(found.contains(name)) << name;
        EXPECT_TRUE(found.at(name) == bits) << "the channel " << name << " has other bits";
    }
}

/// The headers as they are in the file; OpenEXR's files add to theirs.
struct RawHeaders {
    int version = 0;
    std::vector<Imf::Header> parts;

    explicit RawHeaders(const std::filesystem::path& path) {
        const std::vector<std::byte> bytes = test::toByteVector(test::get(path));
        ExrMemoryStream stream(bytes, path.string());
        int magic = 0;
        Imf::Xdr::read<Imf::StreamIO>(stream, magic);
        Imf::Xdr::read<Imf::StreamIO>(stream, version);
        for (;;) {
            Imf::Header header;
            header.readFrom(stream, version);
            if (header.readsNothing()) break;
            parts.push_back(header);
            if (!Imf::isMultiPart(version)) break;
        }
    }
};

/// The types and bytes of all attributes.
std::map<std::string, std::string> attributesOf(const Imf::Header& header) {
    std::map<std::string, std::string> all;
    for (auto it = header.begin(); it != header.end(); ++it) {
        Imf::StdOSStream bytes;
        it.attribute().writeValueTo(bytes, Imf::EXR_VERSION);
        all[it.name()] = std::string(it.attribute().typeName()) + ": " + bytes.str();
    }
    return all;
}

void addAttributes(Imf::Header& header) {
    header.insert("comment", Imf::StringAttribute("grüße\nline two"));
    header.insert("empty", Imf::StringAttribute(""));
    header.insert("exposure", Imf::FloatAttribute(0.1f));
    header.insert("seconds", Imf::DoubleAttribute(0.1));
    header.insert("frame", Imf::IntAttribute(-7));
    header.insert("crop", Imf::Box2iAttribute({{1, 2}, {3, 4}}));
    header.insert("screen", Imf::Box2fAttribute({{-1.5f, 2.0f}, {3.0f, 4.0f}}));
    header.insert("worldToCamera", Imf::M44fAttribute(Imath::M44f(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13,
                                                                  14, 15, std::nanf(""))));
    header.insert("precise", Imf::M44dAttribute(Imath::M44d(0.1)));
    header.insert("jitter", Imf::V2fAttribute({0.25f, -0.5f}));
    header.insert("views", Imf::StringVectorAttribute({"left", "", "right"}));
    header.insert("an attribute whose name has more than thirty-one characters", Imf::IntAttribute(1));
    Imf::addFramesPerSecond(header, Imf::Rational(24000, 1001));
    Imf::IDManifest manifest;
    manifest.add("id").setComponent("name");
    Imf::addIDManifest(header, Imf::CompressedIDManifest(manifest));
    header.insert("join", Imf::StringAttribute("after the manifest"));
    const std::string secret = "\x01\x02 anything \xff";
    const std::vector<std::byte> bytes = test::toByteVector(secret);
    ExrMemoryStream stream(bytes, "opaque");
    Imf::OpaqueAttribute opaque("limpidSecret");
    opaque.readValueFrom(stream, static_cast<int>(bytes.size()), Imf::EXR_VERSION);
    header.insert("secret", opaque);
}

/// Those that must be the same in all parts.
void addSharedAttributes(Imf::Header& header) {
    Imf::addChromaticities(header, Imf::Chromaticities({0.7f, 0.3f}, {0.2f, 0.7f}, {0.1f, 0.1f}));
    Imf::addTimeCode(header, Imf::TimeCode(1, 2, 3, 4, true));
}

void addPreview(Imf::Header& header) {
    const std::vector<Imf::PreviewRgba> pixels(6, Imf::PreviewRgba(10, 200, 30, 40));
    header.setPreviewImage(Imf::PreviewImage(3, 2, pixels.data()));
}

constexpr int frameWidth = 38, frameHeight = 30;
const Box2i frameWindow(V2i(0, 0), V2i(frameWidth - 1, frameHeight - 1));

/// A header with channels of all types, of which R, Z and id will be replaced.
Imf::Header makeHeader(Imf::Compression compression = Imf::ZIP_COMPRESSION, const Box2i& data = frameWindow) {
    Imf::Header header(frameWindow, data, 1.5f, {0.5f, -1.0f}, 2.0f, Imf::INCREASING_Y, compression);
    for (const char* name : {"R", "G", "B", "A", "a layer with a name that is long.X"})
        header.channels().insert(name, Imf::Channel(Imf::HALF));
    for (const char* name : {"Z", "normal.X", "normal.Y"})
        header.channels().insert(name, Imf::Channel(Imf::FLOAT, 1, 1, true));
    for (const char* name : {"id", "samples"}) header.channels().insert(name, Imf::Channel(Imf::UINT));
    return header;
}

/// Distinct integers, exact in every type of channel (and with 24 bits).
std::vector<float> countUp(size_t count, size_t first = 0) {
    std::vector<float> values(count);
    for (size_t i = 0; i < count; ++i) values[i] = static_cast<float>(i + first);
    return values;
}

std::string asHalves(const std::vector<float>& values) {
    std::string bits;
    for (const float value : values) bits += rawBytes(half(value).bits());
    return bits;
}
std::string asFloats(const std::vector<float>& values) {
    std::string bits;
    for (const float value : values) bits += rawBytes(value);
    return bits;
}
std::string asUints(const std::vector<float>& values) {
    std::string bits;
    for (const float value : values) bits += rawBytes(static_cast<uint32_t>(value));
    return bits;
}

/// Replaces R, Z and id of a part whose data window is the frame, and in `want`, too.
void replaceThree(ExrDocument& document, size_t part, PixelBits& want) {
    const size_t count = size_t{document.width()} * document.height();
    document.replace(part, "R", countUp(count, 1));
    document.replace(part, "Z", countUp(count, 2));
    document.replace(part, "id", countUp(count, 3));
    want["R"] = asHalves(countUp(count, 1));
    want["Z"] = asFloats(countUp(count, 2));
    want["id"] = asUints(countUp(count, 3));
}

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

/// Counts what became of damaged files.
struct Outcomes {
    size_t refused = 0, read = 0, unwritable = 0, written = 0;

    /// Reads all channels, replaces one, and writes. Throws nothing.
    void add(const std::string& bytes, const std::filesystem::path& output) {
        ExrDocument document;
        try {
            document = ExrDocument::decode(test::toByteVector(bytes), "damaged.exr");
        } catch (const InputError&) {
            ++refused;
            return;
        } catch (const std::exception& error) {
            ADD_FAILURE() << "decode() threw " << error.what();
            return;
        }
        std::vector<size_t> intact;
        for (size_t i = 0; i < document.parts().size(); ++i) {
            if (readAll(document, i)) intact.push_back(i);
        }
        intact.empty() ? ++refused : ++read;
        if (!intact.empty()) change(document, intact[(refused + read) % intact.size()], output);
    }

  private:
    static bool readAll(ExrDocument& document, size_t part) {
        try {
            for (const ExrPart::Channel& channel : document.parts()[part].channels)
                document.values(part, channel.name);
            return !document.parts()[part].channels.empty();
        } catch (const InputError&) {
        } catch (const std::exception& error) {
            ADD_FAILURE() << "values() threw " << error.what();
        }
        return false;
    }

    void change(ExrDocument& document, size_t part, const std::filesystem::path& output) {
        const std::string channel = document.parts()[part].channels[0].name;
        try {
            const std::vector<float> values(size_t{document.width()} * document.height(), 2.0f);
            document.replace(part, channel, values);
            const std::vector<float> replaced = document.values(part, channel);
            document.write(output);
            ++written;
            EXPECT_EQ(ExrDocument::read(output).values(part, channel), replaced);
            EXPECT_EQ(Imf::MultiPartInputFile(output.c_str()).parts(),
                      static_cast<int>(document.parts().size()));
        } catch (const InputError&) {
            ++unwritable;
        } catch (const std::exception& error) {
            ADD_FAILURE() << "replace() or write() threw " << error.what();
        }
    }
};

/// Small files of several kinds, to be damaged.
class ExrDocumentDamaged : public testing::Test {
  protected:
    static Imf::Header small(const std::string& name, const std::string& type, Imf::Compression compression) {
        Imf::Header header(20, 18);
        header.compression() = compression;
        header.setName(name);
        header.setType(type);
        header.channels().insert("R", Imf::Channel(Imf::HALF));
        header.channels().insert("id", Imf::Channel(Imf::UINT));
        header.insert("comment", Imf::StringAttribute("any"));
        if (Imf::isTiled(type)) header.setTileDescription(Imf::TileDescription(16, 8));
        return header;
    }
    std::string single(const Imf::Header& header) {
        writeSingle(path(), header);
        return test::get(path());
    }
    std::string scanLines() { return single(small("a", Imf::SCANLINEIMAGE, Imf::ZIP_COMPRESSION)); }
    std::string tiles() { return single(small("a", Imf::TILEDIMAGE, Imf::PIZ_COMPRESSION)); }
    std::string parts() {
        std::vector<Imf::Header> headers = {small("rows", Imf::SCANLINEIMAGE, Imf::ZIP_COMPRESSION),
                                            small("tiles", Imf::TILEDIMAGE, Imf::RLE_COMPRESSION),
                                            small("deep", Imf::DEEPSCANLINE, Imf::ZIPS_COMPRESSION),
                                            small("deep tiles", Imf::DEEPTILE, Imf::NO_COMPRESSION),
                                            small("luma", Imf::SCANLINEIMAGE, Imf::NO_COMPRESSION)};
        headers[4].channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
        writeParts(path(), headers);
        return test::get(path());
    }
    std::filesystem::path path() const { return folder_ / "a.exr"; }

    TempFolder folder_;
};

TEST_F(ExrDocumentDamaged, FilesAreRefusedOrReadAndWrittenWhole) {
    std::mt19937 random(17);
    Outcomes outcomes;
    for (const std::string& whole : {scanLines(), tiles(), parts()}) {
        const size_t header = std::min<size_t>(whole.size(), 500);
        for (size_t i = 0; i < 25; ++i) outcomes.add(whole.substr(0, whole.size() * i / 25), path());
        outcomes.add(whole.substr(0, whole.size() - 1), path());
        for (size_t i = 0; i < 50; ++i) {
            std::string bytes = whole;
            const size_t at = random() % (i % 2 == 0 ? header : whole.size());
            bytes[at] = static_cast<char>(static_cast<uint32_t>(bytes[at]) + 1 + random() % 255);
            SCOPED_TRACE(testing::Message() << "byte " << at << " of " << whole.size());
            outcomes.add(bytes, path());
        }
    }
    EXPECT_EQ(outcomes.refused + outcomes.read, 3 * (25 + 1 + 50u));
    EXPECT_GT(outcomes.refused, 50u);
    EXPECT_GT(outcomes.unwritable, 5u);
    EXPECT_GT(outcomes.written, 50u);
}

/// Returns the peak memory of this process in bytes.
size_t peakOfProcess() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<size_t>(usage.ru_maxrss) * 1024;
}

TEST_F(ExrDocumentDamaged, BlocksOfAbsurdSizesAreNotCopied) {
    const std::string whole = parts();
    struct Case {
        std::array<int32_t, 5> begin;  ///< of a block: part, then row or column, row and level
        size_t numbers;                ///< how many of them
        std::vector<std::vector<int32_t>> sizes;
    };
    constexpr int32_t least = std::numeric_limits<int32_t>::min();
    // Of deep blocks: the table's, the samples' (64 bits each).
    const std::vector<std::vector<int32_t>> deepSizes = {
        {0, 1, 100, 0},   {100, 0, 0, 1},       {0x70000000, 0, 100, 0},
        {-1, -1, 100, 0}, {-100, -1, 140, 0},   {140, 0, -100, -1},
        {-40, -1, 0, 0},  {0, least, 0, least}, {0, 0x10000000, 100, 0}};
    const std::vector<Case> cases = {{{0, 16}, 2, {{-1}, {least}, {0x7fffffff}, {1 << 20}}},
                                     {{1, 1, 1, 0, 0}, 5, {{-1}, {least}, {0x7fffffff}, {1 << 20}}},
                                     {{2, 16}, 2, deepSizes},
                                     {{3, 1, 1, 0, 0}, 5, deepSizes},
                                     {{4, 13}, 2, {{-1}, {least}, {0x7fffffff}, {1 << 20}}}};
    const size_t before = peakOfProcess();
    for (const Case& each : cases) {
        const std::string begin(reinterpret_cast<const char*>(each.begin.data()), 4 * each.numbers);
        const size_t at = whole.find(begin);
        ASSERT_NE(at, std::string::npos);
        ASSERT_EQ(whole.find(begin, at + 1), std::string::npos) << "not only a block begins with this";
        for (const std::vector<int32_t>& sizes : each.sizes) {
            SCOPED_TRACE(testing::Message() << "part " << each.begin[0] << ": " << sizes[0]);
            std::string bytes = whole;
            std::memcpy(bytes.data() + at + begin.size(), sizes.data(), 4 * sizes.size());
            ExrDocument document = ExrDocument::decode(test::toByteVector(bytes), "damaged.exr");
            const size_t changed = each.begin[0] == 0 ? 1 : 0;
            document.replace(changed, "R", std::vector<float>(20 * 18));
            std::filesystem::remove(path());
            EXPECT_THROW(document.write(path()), InputError);
            EXPECT_FALSE(std::filesystem::exists(path()));
        }
    }
    EXPECT_LT(peakOfProcess() - before, size_t{200} << 20);
}

/// Overwrites the first numbers of all attributes of this name and type, each in a copy of the file.
std::vector<std::string> patched(const std::string& whole, const std::string& name, const std::string& type,
                                 const std::vector<int32_t>& numbers) {
    std::vector<std::string> files;
    const std::string key = name + '\0' + type + '\0';
    for (size_t at = whole.find(key); at != std::string::npos; at = whole.find(key, at + 1)) {
        files.push_back(whole);
        std::memcpy(files.back().data() + at + key.size() + 4, numbers.data(), 4 * numbers.size());
    }
    return files;
}

TEST_F(ExrDocumentDamaged, AbsurdSizesAreRefusedWithoutAllocatingThem) {
    constexpr int32_t huge = std::numeric_limits<int32_t>::max(), far = 1 << 27;
    const std::vector<std::vector<int32_t>> windows = {
        {0, 0, 59999, 59999}, {0, 0, 16383, 16383}, {0, 0, huge, huge}, {-huge, -huge, huge, huge},
        {0, 0, huge, 0},      {0, 0, 0, huge},      {0, 0, far, 17},    {0, 0, 19, far},
        {-far, 0, far, 0},    {0, -far, 0, far},    {0, 0, far, far},   {5, 5, 4, 4}};
    const size_t before = peakOfProcess();
    for (const std::string& whole : {scanLines(), tiles()}) {
        for (const auto& window : windows) {
            const std::string bytes = patched(whole, "dataWindow", "box2i", window).at(0);
            EXPECT_THROW(ExrDocument::decode(test::toByteVector(bytes), "absurd.exr"), InputError);
        }
    }
    Outcomes outcomes;
    const std::string several = parts();
    const auto addAll = [&](const std::vector<std::string>& files, size_t count) {
        EXPECT_EQ(files.size(), count);
        for (const std::string& bytes : files) outcomes.add(bytes, path());
    };
    for (const auto& window : windows) {
        addAll(patched(several, "dataWindow", "box2i", window), 5);
        addAll(patched(several, "displayWindow", "box2i", window), 5);
    }
    for (const auto& sizes : std::vector<std::vector<int32_t>>{
             {huge, huge}, {huge, 8}, {16, huge}, {-1, -1}, {1, 1}, {1 << 16, 1 << 16}, {0, 0}})
        addAll(patched(several, "tiles", "tiledesc", sizes), 2);
    for (const int32_t count : {huge, -1, 0, far}) addAll(patched(several, "chunkCount", "int", {count}), 5);
    // A wrong size makes OpenEXR take the value's end for the next attribute: a text of 2 GB.
    const std::string text = std::string("a\0string\0", 9) + rawBytes(huge - 1000);
    for (const std::string& type : {std::string("int"), std::string("float"), std::string("v2i")}) {
        std::string bytes = scanLines();
        std::string value(type == "v2i" ? 8 : 4, 'x');
        value += text;
        bytes.insert(8, "_" + std::string(1, '\0') + type + '\0' + rawBytes(uint32_t(value.size())) + value);
        EXPECT_THROW(ExrDocument::decode(test::toByteVector(bytes), "absurd.exr"), InputError);
    }
    EXPECT_GT(outcomes.refused, 100u);
    EXPECT_LT(peakOfProcess() - before, size_t{200} << 20);
}

}  // namespace
}  // namespace limpid::image
