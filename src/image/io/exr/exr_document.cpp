#include "image/io/exr/exr_document.h"

#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfStringVectorAttribute.h>
#include <ImfTiledOutputFile.h>
#include <ImfTiledOutputPart.h>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "base/error.h"
#include "base/files/file.h"
#include "image/io/exr/exr_blocks.h"
#include "image/io/exr/exr_header.h"
#include "image/io/exr/exr_planes.h"

namespace limpid::image {
namespace {

namespace fs = std::filesystem;

/// The decoded channels of a part may take this much memory in total.
constexpr uint64_t maxPartBytes = uint64_t{8} << 30;

std::string compressionName(Imf::Compression compression) {
    constexpr std::array names = {"none",  "rle", "zips", "zip",  "piz",
                                  "pxr24", "b44", "b44a", "dwaa", "dwab"};
    const auto index = static_cast<size_t>(compression);
    return index < names.size() ? names[index] : "unknown";
}

/// True if decoding and encoding again changes values. (PXR24 rounds floats to 24 bits, but only once.)
bool isLossy(Imf::Compression compression) {
    return compression == Imf::B44_COMPRESSION || compression == Imf::B44A_COMPRESSION ||
           compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
}

template <typename Matrix>
std::array<float, 16> elements(const Matrix& matrix) {
    std::array<float, 16> result{};
    for (unsigned i = 0; i < 16; ++i) result[i] = static_cast<float>(matrix[i / 4][i % 4]);
    return result;
}

void addAttribute(ExrPart& part, const std::string& name, const Imf::Attribute& attribute) {
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute)) {
        part.texts[name] = text->value();
    } else if (const auto* list = dynamic_cast<const Imf::StringVectorAttribute*>(&attribute)) {
        if (name == "multiView") part.views = list->value();
    } else if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) {
        part.numbers[name] = static_cast<double>(single->value());
    } else if (const auto* number = dynamic_cast<const Imf::DoubleAttribute*>(&attribute)) {
        part.numbers[name] = number->value();
    } else if (const auto* integer = dynamic_cast<const Imf::IntAttribute*>(&attribute)) {
        part.numbers[name] = integer->value();
    } else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&attribute)) {
        part.matrices[name] = elements(matrix->value());
    } else if (const auto* precise = dynamic_cast<const Imf::M44dAttribute*>(&attribute)) {
        part.matrices[name] = elements(precise->value());
    }
}

/// 0 if the window is empty.
uint64_t pixelsIn(const Imath::Box2i& window) {
    if (window.isEmpty()) return 0;
    return (static_cast<uint64_t>(window.max.x - window.min.x) + 1) *
           (static_cast<uint64_t>(window.max.y - window.min.y) + 1);
}

ExrPart describe(const ExrPartHeader& from) {
    ExrPart part;
    const Imf::Header& header = from.header;
    if (header.hasName()) part.name = header.name();
    if (header.hasView()) part.view = header.view();
    part.unreadable = from.unreadable;
    part.compression = compressionName(header.compression());
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it)
        part.channels.push_back({it.name(), storageOf(it.channel().type)});
    for (auto it = header.begin(); it != header.end(); ++it) {
        const std::string_view name = it.name();
        if (name != "name" && name != "type" && name != "view") addAttribute(part, it.name(), it.attribute());
    }
    return part;
}

void writeTiles(auto&& target, const Imf::FrameBuffer& frame) {
    target.setFrameBuffer(frame);
    target.writeTiles(0, target.numXTiles() - 1, 0, target.numYTiles() - 1);
}

void writeRows(auto&& target, const Imf::Header& header, const Imf::FrameBuffer& frame) {
    target.setFrameBuffer(frame);
    target.writePixels(header.dataWindow().max.y - header.dataWindow().min.y + 1);
}

}  // namespace

struct ExrDocument::Content {
    fs::path name;
    std::vector<std::byte> bytes;  ///< empty once the only part has changed
    std::vector<ExrPartHeader> headers;
    std::vector<ExrPart> parts;
    std::vector<ExrPlanes> planes;  ///< of each part; empty until a channel is used
    std::vector<bool> changed;      ///< of each part: pixels
    /// Attached channels: they come after the file's own parts, and are not written.
    std::vector<LayeredImage> attached;

    bool isAttached(size_t part) const { return part >= headers.size(); }

    Imath::Box2i display() const { return headers.front().header.displayWindow(); }

    size_t channelOf(size_t part, std::string_view channel) const {
        const auto& channels = parts.at(part).channels;
        const auto found = std::find_if(channels.begin(), channels.end(),
                                        [&](const ExrPart::Channel& c) { return c.name == channel; });
        if (found == channels.end()) throw Error(fmt::format("there is no channel '{}'", channel));
        return static_cast<size_t>(found - channels.begin());
    }

    ExrPlanes& decoded(size_t part) {
        if (!planes[part].empty()) return planes[part];
        const ExrPart& description = parts[part];
        if (!description.unreadable.empty())
            throw InputError(name, fmt::format("the part '{}' {}, which is not supported", description.name,
                                               description.unreadable));
        readingExr(name, [&] { decode(part); });
        return planes[part];
    }

    void decode(size_t index) {
        const ExrFrame& frame = headers[index].frame;
        const Imath::Box2i& data = frame.data;
        const uint64_t pixels = pixelsIn(data);
        if (pixels > maxPartBytes / frame.bytesPerPixel)
            throw InputError(name, fmt::format("has a part of {} million pixels with {} bytes each, which is "
                                               "too much",
                                               pixels / 1000000, frame.bytesPerPixel));
        ExrPlanes decodedPlanes(data, parts[index].channels);
        ExrMemoryStream stream(bytes, name.string());
        // Do not reconstruct a damaged chunk table: an incomplete file is an error, not a picture with holes.
        Imf::MultiPartInputFile file(stream, Imf::globalThreadCount(), false);
        Imf::InputPart part(file, static_cast<int>(index));
        part.setFrameBuffer(decodedPlanes.frameBuffer(parts[index].channels));
        part.readPixels(data.min.y, data.max.y);
        planes[index] = std::move(decodedPlanes);
    }

    /// A file with one part is written anew if a channel changes; only what nobody changes is copied.
    void forgetBytes() {
        if (headers.size() == 1 && changed[0]) std::vector<std::byte>().swap(bytes);
    }

    /// Returns the header to write for a part.
    Imf::Header headerToWrite(size_t part) const {
        Imf::Header header = headers[part].header;
        if (!changed[part]) return header;
        if (isLossy(header.compression())) header.compression() = Imf::ZIP_COMPRESSION;
        if (header.hasTileDescription() && header.tileDescription().mode != Imf::ONE_LEVEL)
            throw InputError(name, "has several resolutions (mip levels), which is not supported");
        return header;
    }

    /// Writes a file with one part, without the attributes that files with several need.
    void writeOnly(Imf::OStream& stream) const {
        const Imf::Header header = headerToWrite(0);
        const Imf::FrameBuffer frame = planes[0].frameBuffer(parts[0].channels);
        if (header.hasTileDescription())
            writeTiles(Imf::TiledOutputFile(stream, header), frame);
        else
            writeRows(Imf::OutputFile(stream, header), header, frame);
    }

    void write(std::ofstream& target, const std::string& targetName) const {
        Imf::StdOFStream stream(target, targetName.c_str());
        if (std::find(changed.begin(), changed.end(), true) == changed.end()) {
            target.write(reinterpret_cast<const char*>(bytes.data()),
                         static_cast<std::streamsize>(bytes.size()));
            return;
        }
        if (headers.size() == 1) return writeOnly(stream);
        ExrMemoryStream source(bytes, name.string());
        Imf::MultiPartInputFile from(source, Imf::globalThreadCount(), false);
        std::vector<Imf::Header> toWrite;
        for (size_t i = 0; i < headers.size(); ++i) toWrite.push_back(headerToWrite(i));
        Imf::MultiPartOutputFile to(stream, toWrite.data(), static_cast<int>(toWrite.size()));
        for (size_t i = 0; i < headers.size(); ++i) {
            const auto index = static_cast<int>(i);
            const Imf::FrameBuffer frame = planes[i].frameBuffer(parts[i].channels);
            if (!changed[i])
                copyExrBlocks(from, to, index, toWrite[i], bytes.size());
            else if (toWrite[i].hasTileDescription())
                writeTiles(Imf::TiledOutputPart(to, index), frame);
            else
                writeRows(Imf::OutputPart(to, index), toWrite[i], frame);
        }
    }
};

ExrDocument::ExrDocument(std::unique_ptr<Content> content) : content_(std::move(content)) {}
ExrDocument::ExrDocument() = default;
ExrDocument::ExrDocument(ExrDocument&&) noexcept = default;
ExrDocument& ExrDocument::operator=(ExrDocument&&) noexcept = default;
ExrDocument::~ExrDocument() = default;

ExrDocument ExrDocument::of(const LayeredImage& image, const fs::path& name) {
    auto content = std::make_unique<Content>();
    content->name = name;
    Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const Channel& channel : image.channels)
        header.channels().insert(channel.name, Imf::Channel(toImf(channel.storage)));
    content->headers.push_back({header, {header.dataWindow(), header.displayWindow()}, {}});
    content->parts.push_back(describe(content->headers.front()));
    content->planes.emplace_back(header.dataWindow(), content->parts.front().channels);
    content->changed.push_back(true);
    ExrDocument document(std::move(content));
    for (const Channel& channel : image.channels) document.replace(0, channel.name, channel.values);
    return document;
}

void ExrDocument::attach(const std::string& part, LayeredImage image, const fs::path& name) {
    if (image.width != width() || image.height != height())
        throw InputError(name, fmt::format("has {}x{} pixels, but {} has {}x{}", image.width, image.height,
                                           content_->name.string(), width(), height()));
    ExrPart& description = content_->parts.emplace_back();
    description.name = part;
    description.attached = true;
    for (const Channel& channel : image.channels)
        description.channels.push_back({channel.name, channel.storage});
    content_->attached.push_back(std::move(image));
}

void ExrDocument::fill(size_t part, std::string_view channel, std::vector<float> values) {
    const size_t c = content_->channelOf(part, channel);
    if (!content_->isAttached(part)) throw Error("only attached channels are filled");
    if (values.size() != size_t{width()} * height()) throw Error("the channel has another size");
    content_->attached[part - content_->headers.size()].channels[c].values = std::move(values);
}

ExrDocument ExrDocument::read(const fs::path& path) {
    return decode(readFile(path), path);
}

ExrDocument ExrDocument::decode(std::vector<std::byte> bytes, const fs::path& name) {
    useExrThreads();
    auto content = std::make_unique<Content>();
    content->name = name;
    content->bytes = std::move(bytes);
    readingExr(name, [&] {
        content->headers = checkExrParts(content->bytes, name);
        for (const ExrPartHeader& header : content->headers) content->parts.push_back(describe(header));
    });
    content->planes.resize(content->parts.size());
    content->changed.resize(content->parts.size());
    return ExrDocument(std::move(content));
}

const fs::path& ExrDocument::name() const {
    return content_->name;
}
uint32_t ExrDocument::width() const {
    const Imath::Box2i display = content_->display();
    return static_cast<uint32_t>(display.max.x - display.min.x) + 1;
}
uint32_t ExrDocument::height() const {
    const Imath::Box2i display = content_->display();
    return static_cast<uint32_t>(display.max.y - display.min.y) + 1;
}

float ExrDocument::pixelAspect() const {
    const float aspect = content_->headers.front().header.pixelAspectRatio();
    return aspect >= 1e-6f && aspect <= 1e6f ? aspect : 1.0f;  // as OpenEXR limits it
}

std::span<const ExrPart> ExrDocument::parts() const {
    return content_->parts;
}

void ExrDocument::decode(size_t part) {
    if (!content_->isAttached(part)) content_->decoded(part);
}

uint64_t ExrDocument::decodedBytes(size_t part) const {
    if (content_->isAttached(part) || !content_->parts[part].unreadable.empty()) return 0;
    const ExrFrame& frame = content_->headers[part].frame;
    return pixelsIn(frame.data) * frame.bytesPerPixel;
}

uint64_t ExrDocument::pixelsOutside(size_t part) const {
    if (content_->isAttached(part) || !content_->parts[part].unreadable.empty()) return 0;
    const Imath::Box2i data = content_->headers[part].frame.data, display = content_->display();
    const Imath::Box2i shared({std::max(data.min.x, display.min.x), std::max(data.min.y, display.min.y)},
                              {std::min(data.max.x, display.max.x), std::min(data.max.y, display.max.y)});
    return pixelsIn(data) - pixelsIn(shared);
}

std::vector<float> ExrDocument::values(size_t part, std::string_view channel) {
    std::vector<float> result(size_t{width()} * height());
    read(part, channel, result, 1);
    return result;
}

void ExrDocument::read(size_t part, std::string_view channel, std::span<float> to, size_t stride) {
    const size_t c = content_->channelOf(part, channel);
    if (size_t{width()} * height() > (to.size() + stride - 1) / stride)
        throw Error("the target is too small");
    if (content_->isAttached(part)) {
        const auto& values = content_->attached[part - content_->headers.size()].channels[c].values;
        if (values.empty()) throw Error(fmt::format("the attached channel '{}' has no values", channel));
        for (size_t p = 0; p < values.size(); ++p) to[stride * p] = values[p];
        return;
    }
    const Storage storage = content_->parts[part].channels[c].storage;
    const ExrPlanes& planes = content_->decoded(part);
    planes.forShared(content_->display(), [&](size_t inPlane, size_t inDisplay) {
        to[stride * inDisplay] = planes.get(c, storage, inPlane);
    });
}

void ExrDocument::replace(size_t part, std::string_view channel, std::span<const float> values) {
    const size_t c = content_->channelOf(part, channel);
    if (values.size() != size_t{width()} * height()) throw Error("the channel has another size");
    if (content_->isAttached(part)) throw Error("an attached channel cannot be replaced");
    const Storage storage = content_->parts[part].channels[c].storage;
    ExrPlanes& planes = content_->decoded(part);
    planes.forShared(content_->display(), [&](size_t inPlane, size_t inDisplay) {
        planes.set(c, storage, inPlane, values[inDisplay]);
    });
    content_->changed[part] = true;
    content_->forgetBytes();
}

void ExrDocument::setText(size_t part, const std::string& attribute, const std::string& text) {
    try {
        content_->headers.at(part).header.insert(attribute, Imf::StringAttribute(text));
    } catch (const Iex::BaseExc&) {
        throw Error(fmt::format("the attribute '{}' cannot be a text", attribute));
    }
    content_->parts[part].texts[attribute] = text;
}

void ExrDocument::write(const fs::path& path) const {
    writeAtomically(path, [&](const fs::path& temporary) {
        std::ofstream file(temporary, std::ios::binary);
        try {
            content_->write(file, path.string());
        } catch (const Error&) {
            throw;
        } catch (const std::exception& error) {
            // OpenEXR does not say which of the two files is at fault.
            if (file) throw InputError(content_->name, fmt::format("cannot be copied: {}", error.what()));
            throw OutputError(path, fmt::format("cannot be written: {}", error.what()));
        }
        // The library's destructors swallow errors, so check the stream.
        file.close();
        if (!file) throw OutputError(path, "cannot be written: the disk may be full");
    });
}

}  // namespace limpid::image
