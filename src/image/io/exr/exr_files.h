// For tests: writes EXR files of every kind with OpenEXR itself, and reads them back in the channels' own
// types.
#pragma once

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

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "image/io/exr/exr_document.h"
#include "image/io/exr/exr_header.h"
#include "image/io/temp_folder.h"

namespace limpid::image::test {

using Imath::Box2i;
using Imath::V2i;

/// A channel's pixels in its own type, by name; of levels other than the first with their numbers: "R 1 1".
using PixelBits = std::map<std::string, std::string>;

inline size_t bytesOf(Imf::PixelType type) {
    return type == Imf::HALF ? 2 : 4;
}

template <typename T>
inline std::string rawBytes(const T& value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// Returns the bits of any value, every third of which conversions or compressions may change: signalling and
/// other NaNs, infinities, -0, denormals, the largest.
inline std::string oddBits(Imf::PixelType type, std::mt19937& random) {
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

inline int rowsOf(const Imf::Header& header) {
    return header.dataWindow().max.y - header.dataWindow().min.y + 1;
}

/// Calls action(lx, ly) for each level of a tiled file.
template <typename Tiled, typename Action>
inline void forLevels(const Tiled& file, Action action) {
    for (int ly = 0; ly < file.numYLevels(); ++ly) {
        for (int lx = 0; lx < file.numXLevels(); ++lx) {
            if (file.isValidLevel(lx, ly)) action(lx, ly);
        }
    }
}

inline void fillRows(auto&& target, const Imf::Header& header, uint32_t seed) {
    FlatMemory memory(header.channels(), header.dataWindow());
    memory.fill(seed);
    target.setFrameBuffer(memory.frame());
    target.writePixels(rowsOf(header));
}

inline void fillTiles(auto&& target, const Imf::Header& header, uint32_t seed) {
    forLevels(target, [&](int lx, int ly) {
        FlatMemory memory(header.channels(), target.dataWindowForLevel(lx, ly));
        memory.fill(seed++);
        target.setFrameBuffer(memory.frame());
        target.writeTiles(0, target.numXTiles(lx) - 1, 0, target.numYTiles(ly) - 1, lx, ly);
    });
}

/// Writes a file with one part, tiled if the header has a description of tiles.
inline void writeSingle(const std::filesystem::path& path, const Imf::Header& header, uint32_t seed = 5) {
    if (header.hasTileDescription())
        fillTiles(Imf::TiledOutputFile(path.c_str(), header), header, seed);
    else
        fillRows(Imf::OutputFile(path.c_str(), header), header, seed);
}

inline void writeParts(const std::filesystem::path& path, const std::vector<Imf::Header>& headers) {
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

inline ReadPart readRows(Imf::InputPart part) {
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

inline ReadPart readTiles(Imf::TiledInputPart part) {
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

inline ReadPart readDeep(Imf::DeepScanLineInputPart part) {
    const Box2i window = part.header().dataWindow();
    DeepMemory memory(part.header().channels(), window);
    part.setFrameBuffer(memory.frame());
    part.readPixelSampleCounts(window.min.y, window.max.y);
    memory.allocate();
    part.readPixels(window.min.y, window.max.y);
    return {memory.bits(), {}};
}

inline ReadPart readDeepTiles(Imf::DeepTiledInputPart part) {
    DeepMemory memory(part.header().channels(), part.header().dataWindow());
    part.setFrameBuffer(memory.frame());
    part.readPixelSampleCounts(0, part.numXTiles(0) - 1, 0, part.numYTiles(0) - 1);
    memory.allocate();
    part.readTiles(0, part.numXTiles(0) - 1, 0, part.numYTiles(0) - 1);
    return {memory.bits(), {}};
}

inline std::vector<ReadPart> readParts(const std::filesystem::path& path) {
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

inline void expectSamePixels(const PixelBits& found, const PixelBits& want) {
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
inline std::map<std::string, std::string> attributesOf(const Imf::Header& header) {
    std::map<std::string, std::string> all;
    for (auto it = header.begin(); it != header.end(); ++it) {
        Imf::StdOSStream bytes;
        it.attribute().writeValueTo(bytes, Imf::EXR_VERSION);
        all[it.name()] = std::string(it.attribute().typeName()) + ": " + bytes.str();
    }
    return all;
}

inline void addAttributes(Imf::Header& header) {
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
inline void addSharedAttributes(Imf::Header& header) {
    Imf::addChromaticities(header, Imf::Chromaticities({0.7f, 0.3f}, {0.2f, 0.7f}, {0.1f, 0.1f}));
    Imf::addTimeCode(header, Imf::TimeCode(1, 2, 3, 4, true));
}

inline void addPreview(Imf::Header& header) {
    const std::vector<Imf::PreviewRgba> pixels(6, Imf::PreviewRgba(10, 200, 30, 40));
    header.setPreviewImage(Imf::PreviewImage(3, 2, pixels.data()));
}

inline constexpr int frameWidth = 38, frameHeight = 30;
inline const Box2i frameWindow(V2i(0, 0), V2i(frameWidth - 1, frameHeight - 1));

/// A header with channels of all types, of which R, Z and id will be replaced.
inline Imf::Header makeHeader(Imf::Compression compression = Imf::ZIP_COMPRESSION,
                              const Box2i& data = frameWindow) {
    Imf::Header header(frameWindow, data, 1.5f, {0.5f, -1.0f}, 2.0f, Imf::INCREASING_Y, compression);
    for (const char* name : {"R", "G", "B", "A", "a layer with a name that is long.X"})
        header.channels().insert(name, Imf::Channel(Imf::HALF));
    for (const char* name : {"Z", "normal.X", "normal.Y"})
        header.channels().insert(name, Imf::Channel(Imf::FLOAT, 1, 1, true));
    for (const char* name : {"id", "samples"}) header.channels().insert(name, Imf::Channel(Imf::UINT));
    return header;
}

/// Distinct integers, exact in every type of channel (and with 24 bits).
inline std::vector<float> countUp(size_t count, size_t first = 0) {
    std::vector<float> values(count);
    for (size_t i = 0; i < count; ++i) values[i] = static_cast<float>(i + first);
    return values;
}

inline std::string asHalves(const std::vector<float>& values) {
    std::string bits;
    for (const float value : values) bits += rawBytes(half(value).bits());
    return bits;
}
inline std::string asFloats(const std::vector<float>& values) {
    std::string bits;
    for (const float value : values) bits += rawBytes(value);
    return bits;
}
inline std::string asUints(const std::vector<float>& values) {
    std::string bits;
    for (const float value : values) bits += rawBytes(static_cast<uint32_t>(value));
    return bits;
}

/// Replaces R, Z and id of a part whose data window is the frame, and in `want`, too.
inline void replaceThree(ExrDocument& document, size_t part, PixelBits& want) {
    const size_t count = size_t{document.width()} * document.height();
    document.replace(part, "R", countUp(count, 1));
    document.replace(part, "Z", countUp(count, 2));
    document.replace(part, "id", countUp(count, 3));
    want["R"] = asHalves(countUp(count, 1));
    want["Z"] = asFloats(countUp(count, 2));
    want["id"] = asUints(countUp(count, 3));
}

}  // namespace limpid::image::test
