#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "base/error.h"
#include "base/files/file.h"
#include "image/io/exr/exr.h"
#include "image/io/exr/exr_header.h"
#include "image/io/exr/exr_values.h"

namespace limpid::image {
namespace {

Imf::Compression toImf(Compression compression) {
    switch (compression) {
        case Compression::None:
            return Imf::NO_COMPRESSION;
        case Compression::Rle:
            return Imf::RLE_COMPRESSION;
        case Compression::Zips:
            return Imf::ZIPS_COMPRESSION;
        case Compression::Zip:
            return Imf::ZIP_COMPRESSION;
        case Compression::Piz:
            return Imf::PIZ_COMPRESSION;
    }
    throw Error("unknown EXR compression");
}

/// One channel's values in the file's type.
struct StoredChannel {
    std::vector<half> halves;
    std::vector<uint32_t> uints;
    const char* base = nullptr;
    size_t bytesPerValue = 4;
};

StoredChannel store(const Channel& channel) {
    StoredChannel stored;
    const std::vector<float>& values = channel.values;
    if (channel.storage == Storage::Half) {
        stored.halves.resize(values.size());
        std::transform(values.begin(), values.end(), stored.halves.begin(), toHalf);
        stored.base = reinterpret_cast<const char*>(stored.halves.data());
        stored.bytesPerValue = 2;
    } else if (channel.storage == Storage::Uint) {
        stored.uints.resize(values.size());
        std::transform(values.begin(), values.end(), stored.uints.begin(), toUint);
        stored.base = reinterpret_cast<const char*>(stored.uints.data());
    } else {
        stored.base = reinterpret_cast<const char*>(values.data());
    }
    return stored;
}

void checkContent(const LayeredImage& image) {
    if (image.width == 0 || image.height == 0 || image.channels.empty()) {
        throw Error("an EXR file needs at least one pixel and one channel");
    }
    for (const Channel& channel : image.channels) {
        if (channel.name.empty()) throw Error("an EXR channel needs a name");
        if (channel.values.size() != size_t{image.width} * image.height) {
            throw Error(fmt::format("channel '{}' has {} values, the image {}x{} pixels", channel.name,
                                    channel.values.size(), image.width, image.height));
        }
        if (image.find(channel.name) != &channel) {
            throw Error(fmt::format("there are two channels named '{}'", channel.name));
        }
    }
}

Imf::Header makeHeader(const LayeredImage& image, Compression compression) {
    Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
    header.compression() = toImf(compression);
    for (const Channel& channel : image.channels) {
        header.channels().insert(channel.name, Imf::Channel(toImf(channel.storage)));
    }
    // These are strings too, but have a meaning for readers.
    constexpr std::array<std::string_view, 3> reserved = {"name", "type", "view"};
    for (const auto& [key, value] : image.metadata) {
        const bool taken = std::find(reserved.begin(), reserved.end(), key) != reserved.end();
        if (key.empty() || taken || header.find(key) != header.end()) {
            throw Error(fmt::format("'{}' cannot be the name of EXR metadata", key));
        }
        header.insert(key, Imf::StringAttribute(value));
    }
    return header;
}

void writeTo(std::ofstream& file, const std::string& name, const Imf::Header& header,
             const LayeredImage& image) {
    std::vector<StoredChannel> stored;
    stored.reserve(image.channels.size());
    Imf::FrameBuffer frame;
    for (const Channel& channel : image.channels) {
        const StoredChannel& s = stored.emplace_back(store(channel));
        // The library only reads through this pointer, but its type serves reading and writing.
        frame.insert(channel.name, Imf::Slice(toImf(channel.storage), const_cast<char*>(s.base),
                                              s.bytesPerValue, s.bytesPerValue * image.width));
    }
    useExrThreads();
    Imf::StdOFStream stream(file, name.c_str());
    Imf::OutputFile output(stream, header);
    output.setFrameBuffer(frame);
    output.writePixels(static_cast<int>(image.height));
}

}  // namespace

void writeExr(const std::filesystem::path& path, const LayeredImage& image, Compression compression) {
    checkContent(image);
    const Imf::Header header = makeHeader(image, compression);
    writeAtomically(path, [&](const std::filesystem::path& temporary) {
        std::ofstream file(temporary, std::ios::binary);
        try {
            writeTo(file, path.string(), header, image);
        } catch (const Error&) {
            throw;
        } catch (const std::exception& error) {
            throw OutputError(path, fmt::format("cannot be written: {}", error.what()));
        }
        // OutputFile's destructor writes the line table and swallows errors, so check the stream.
        file.close();
        if (!file) throw OutputError(path, "cannot be written: the disk may be full");
    });
}

}  // namespace limpid::image
