#include "image/io/exr/exr_header.h"

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfIDManifestAttribute.h>
#include <ImfPartType.h>
#include <ImfThreading.h>
#include <ImfTileDescription.h>
#include <ImfVersion.h>
#include <ImfXdr.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <string_view>
#include <thread>

#include "base/error.h"
#include "base/files/file_kind.h"
#include "image/io/rows/limits.h"

namespace limpid::image {
namespace {

namespace fs = std::filesystem;

/// The maximum size of a decoding buffer, which holds a row of chunks.
constexpr uint64_t maxChunkBytes = uint64_t{1} << 30;
/// OpenEXR allocates several whole tiles at once, even beyond the picture's edge. Above this size, they may
/// be at most as large as the picture, which is limited by the file's size.
constexpr uint64_t maxTileBytes = uint64_t{1} << 26;

/// Returns the size of attributes that OpenEXR reads whatever size is stated; 0 for those of other types.
uint32_t fixedSize(std::string_view type) {
    const auto isOneOf = [&](auto... types) { return ((type == types) || ...); };
    if (isOneOf("compression", "deepImageState", "envmap", "lineOrder")) return 1;
    if (isOneOf("float", "int")) return 4;
    if (isOneOf("double", "rational", "timecode", "v2f", "v2i")) return 8;
    if (type == "tiledesc") return 9;
    if (isOneOf("v3f", "v3i")) return 12;
    if (isOneOf("box2f", "box2i", "v2d")) return 16;
    if (type == "v3d") return 24;
    if (type == "keycode") return 28;
    if (type == "chromaticities") return 32;
    if (type == "m33f") return 36;
    if (type == "m44f") return 64;
    if (type == "m33d") return 72;
    return type == "m44d" ? 128 : 0;
}

/// Walks the raw attribute lists. OpenEXR would allocate an attribute's claimed size before noticing that the
/// file is shorter. If a size is not that of the type, it would take other bytes for the next attribute.
class AttributeWalk {
  public:
    AttributeWalk(std::span<const std::byte> bytes, const fs::path& name, size_t position)
        : bytes_(bytes), name_(name), position_(position) {}

    /// Skips one header. Returns false if it was empty, which ends a multi-part file's list.
    bool header() {
        bool any = false;
        while (!text().empty()) {
            const std::string type = text();
            const uint32_t size = number();
            const size_t begin = position_;
            skip(size);
            if (!fits(type, size)) fail();
            if (type == "chlist" && channels(begin) != position_) fail();
            any = true;
        }
        return any;
    }

  private:
    static bool fits(std::string_view type, uint32_t size) {
        if (const uint32_t fixed = fixedSize(type)) return size == fixed;
        return type != "floatvector" || size % 4 == 0;
    }

    /// Returns where the list of channels ends that begins there.
    size_t channels(size_t begin) const {
        AttributeWalk list(bytes_, name_, begin);
        while (!list.text().empty()) list.skip(16);
        return list.position_;
    }

    void skip(size_t count) {
        if (count > bytes_.size() - position_) fail();
        position_ += count;
    }

    [[noreturn]] void fail() const {
        throw InputError(name_, "is no valid EXR file: its header is cut off or damaged");
    }

    std::string text() {
        std::string value;
        while (position_ < bytes_.size() && value.size() < 256) {
            const auto c = static_cast<char>(bytes_[position_++]);
            if (c == '\0') return value;
            value += c;
        }
        fail();
    }

    uint32_t number() {
        if (bytes_.size() - position_ < 4) fail();
        uint32_t value = 0;
        for (unsigned i = 0; i < 4; ++i) value |= std::to_integer<uint32_t>(bytes_[position_++]) << (8 * i);
        return value;
    }

    std::span<const std::byte> bytes_;
    const fs::path& name_;
    size_t position_;
};

int rowsPerChunk(Imf::Compression compression) {
    switch (compression) {
        case Imf::ZIP_COMPRESSION:
        case Imf::PXR24_COMPRESSION:
            return 16;
        case Imf::PIZ_COMPRESSION:
        case Imf::B44_COMPRESSION:
        case Imf::B44A_COMPRESSION:
        case Imf::DWAA_COMPRESSION:
            return 32;
        case Imf::DWAB_COMPRESSION:
            return 256;
        default:
            return 1;
    }
}

/// Returns a bound above the best ratio that each method achieves on a constant picture (DWA: 37,000 on rows
/// of 131,072 pixels).
uint64_t largestRatio(Imf::Compression compression) {
    if (compression == Imf::NO_COMPRESSION) return 1;
    const bool dwa = compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
    return dwa ? uint64_t{1} << 16 : 2048;
}

/// Returns a window's width and height. Rejects coordinates so large that they could overflow.
struct Size {
    uint64_t width, height;
};
Size sizeOf(const Imath::Box2i& box, const fs::path& name) {
    constexpr int far = 1 << 28;
    for (const int v : {box.min.x, box.min.y, box.max.x, box.max.y}) {
        if (v < -far || v > far) throw InputError(name, "has a data or display window beyond ±2^28");
    }
    if (box.min.x > box.max.x || box.min.y > box.max.y) throw InputError(name, "has an empty picture window");
    return {static_cast<uint64_t>(box.max.x - box.min.x) + 1,
            static_cast<uint64_t>(box.max.y - box.min.y) + 1};
}

uint64_t checkChannels(const Imf::Header& header, const fs::path& name) {
    uint64_t bytesPerPixel = 0;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        const Imf::Channel& channel = it.channel();
        if (channel.type != Imf::HALF && channel.type != Imf::FLOAT && channel.type != Imf::UINT) {
            throw InputError(name, fmt::format("has the channel '{}' of an unknown type", it.name()));
        }
        bytesPerPixel += channel.type == Imf::HALF ? 2 : 4;
    }
    if (bytesPerPixel == 0) throw InputError(name, "has no channels");
    return bytesPerPixel;
}

/// Checks that the file is long enough for its chunks, and that chunks have a plausible size. Returns rows
/// per chunk.
int checkChunks(const Imf::Header& header, Size data, uint64_t bytesPerPixel, bool tiled, size_t fileBytes,
                const fs::path& name) {
    uint64_t rows = static_cast<uint64_t>(rowsPerChunk(header.compression()));
    uint64_t columns = data.width;
    if (tiled) {
        if (!header.hasTileDescription()) throw InputError(name, "is tiled but has no tile description");
        rows = header.tileDescription().ySize;
        columns = header.tileDescription().xSize;
        if (rows == 0 || columns == 0 || rows > maxPixels || columns > maxPixels) {
            throw InputError(name, fmt::format("has tiles of {}x{} pixels", columns, rows));
        }
        const uint64_t tile = rows * columns;
        if (tile > maxTileBytes / bytesPerPixel && tile > data.width * data.height) {
            throw InputError(name, fmt::format("has tiles of {}x{} pixels in a picture of {}x{}", columns,
                                               rows, data.width, data.height));
        }
    }
    // Rows of tiles are cached whole, so use the larger width.
    if (rows > maxChunkBytes / (std::max(columns, data.width) * bytesPerPixel)) {
        throw InputError(name, fmt::format("has blocks of {}x{} pixels, which is too much", columns, rows));
    }
    const uint64_t chunks = ((data.height + rows - 1) / rows) * ((data.width + columns - 1) / columns);
    // Each chunk has 8 bytes in the table and at least 8 of its own.
    if (chunks > fileBytes / 16) {
        throw InputError(
            name, fmt::format("claims {} blocks of pixels, which {} bytes cannot hold", chunks, fileBytes));
    }
    return static_cast<int>(rows);
}

/// Returns why the part's pixels cannot be decoded; empty if they can.
std::string whyUnreadable(const Imf::Header& header, int version) {
    const bool deepType = header.hasType() && Imf::isDeepData(header.type());
    // In a file with several parts, the flag only says that one of them is deep.
    const bool deepFile = Imf::isNonImage(version) && !Imf::isMultiPart(version);
    if (deepFile || deepType) return "is deep";
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        const Imf::Channel& channel = it.channel();
        if (channel.xSampling != 1 || channel.ySampling != 1)
            return fmt::format("has the subsampled channel '{}'", it.name());
    }
    return {};
}

/// Decides as OpenEXR does, which ignores the types of files with one part.
bool isTiledPart(const Imf::Header& header, int version) {
    const bool typed = Imf::isMultiPart(version) || Imf::isNonImage(version);
    return typed && header.hasType() ? Imf::isTiled(header.type()) : Imf::isTiled(version);
}

/// The display window may be far larger than a cropped render inside it, but must be limited, since it is
/// allocated.
void checkDisplay(Size data, Size display, uint64_t bytesPerPixel, size_t fileBytes, const fs::path& name) {
    checkDimensions(name, display.width, display.height, fileBytes, maxPixels);
    const uint64_t pixels = display.width * display.height;
    const bool large = pixels > (uint64_t{1} << 24) || pixels * (bytesPerPixel / 2) > (uint64_t{1} << 26);
    if (large && pixels / 64 > data.width * data.height) {
        throw InputError(name, fmt::format("has a frame of {}x{} pixels around {}x{} stored ones",
                                           display.width, display.height, data.width, data.height));
    }
}

ExrFrame checkPart(const Imf::Header& header, int version, size_t fileBytes, const fs::path& name) {
    const bool tiled = isTiledPart(header, version);
    ExrFrame frame{header.dataWindow(), header.displayWindow()};
    const Size data = sizeOf(frame.data, name);
    const uint64_t bytesPerPixel = checkChannels(header, name);
    frame.bytesPerPixel = bytesPerPixel;
    const uint64_t ratio = largestRatio(header.compression());
    checkDimensions(name, data.width, data.height, fileBytes, maxPixels);
    if (data.width * data.height > ratio * fileBytes / bytesPerPixel + 1) {
        throw InputError(name, fmt::format("claims {}x{} pixels, which {} bytes cannot hold", data.width,
                                           data.height, fileBytes));
    }
    frame.rowsPerChunk = checkChunks(header, data, bytesPerPixel, tiled, fileBytes, name);
    checkDisplay(data, sizeOf(frame.display, name), bytesPerPixel, fileBytes, name);
    return frame;
}

/// Removes an attribute. OpenEXR's own function leaks it.
void removeAttribute(Imf::Header& header, std::string_view attribute) {
    Imf::Header others;
    for (auto it = header.begin(); it != header.end(); ++it) {
        if (it.name() != attribute) others.insert(it.name(), it.attribute());
    }
    header = others;
}

/// Removes what OpenEXR would write though it may be wrong in a changed file.
void removeMisleading(Imf::Header& header, int version, bool only) {
    // Left over from a tiled file that was converted: OpenEXR would mark the file as tiled.
    if (header.hasTileDescription() && !isTiledPart(header, version)) removeAttribute(header, "tiles");
    // The number of blocks depends on the compression. With several parts, OpenEXR sets it.
    if (only && header.hasChunkCount()) removeAttribute(header, "chunkCount");
}

/// If no part can be read, compares the frame with what the parts store. Else a part that can be read has
/// been compared with it, and others may be small crops.
void checkUnreadable(const std::vector<ExrPartHeader>& parts, size_t fileBytes, const fs::path& name) {
    const auto isReadable = [](const ExrPartHeader& part) { return part.unreadable.empty(); };
    if (std::ranges::any_of(parts, isReadable)) return;
    constexpr uint64_t oneFloat = 4;
    for (const ExrPartHeader& part : parts)
        checkDisplay(sizeOf(part.header.dataWindow(), name), sizeOf(part.header.displayWindow(), name),
                     oneFloat, fileBytes, name);
}

/// Reads the magic number and returns the version field.
int checkVersion(ExrMemoryStream& stream, std::span<const std::byte> bytes, const fs::path& name) {
    int magic = 0, version = 0;
    if (bytes.size() < 8) throw InputError(name, "is no EXR file: it is too short");
    Imf::Xdr::read<Imf::StreamIO>(stream, magic);
    Imf::Xdr::read<Imf::StreamIO>(stream, version);
    if (magic != Imf::MAGIC) throw InputError(name, "is no EXR file: " + describeBeginning(bytes));
    if (Imf::getVersion(version) != Imf::EXR_VERSION || !Imf::supportsFlags(Imf::getFlags(version)))
        throw InputError(name, "is an EXR file of an unknown version");
    return version;
}

/// OpenEXR 3.1 reads 4 bytes too many of an ID manifest, which are the name of the next attribute. It copies
/// attributes of unknown types as they are.
void makeIdManifestsUnknown() {
    static std::once_flag once;
    std::call_once(once, [] {
        const Imf::Header registersAllTypes;
        Imf::IDManifestAttribute::unRegisterAttributeType();
    });
}

/// Checks that all attribute lists are complete, and returns the number of parts.
uint64_t checkLists(std::span<const std::byte> bytes, int version, const fs::path& name) {
    makeIdManifestsUnknown();
    AttributeWalk walk(bytes, name, 8);
    if (!walk.header()) throw InputError(name, "is an EXR file without a header");
    uint64_t count = 1;
    while (Imf::isMultiPart(version) && walk.header()) ++count;
    return count;
}

}  // namespace

void useExrThreads() {
    static std::once_flag once;
    std::call_once(once, [] {
        if (Imf::globalThreadCount() == 0) {
            Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
        }
    });
}

bool ExrMemoryStream::read(char target[], int count) {
    // OpenEXR does not check all sizes in a damaged file before it reads that much.
    if (count < 0) throw std::runtime_error("it has a block of a negative size");
    const auto wanted = static_cast<uint64_t>(count);
    if (position_ > bytes_.size() || wanted > bytes_.size() - position_) {
        throw std::runtime_error("it ends too early");
    }
    if (wanted > 0) std::memcpy(target, bytes_.data() + position_, wanted);
    position_ += wanted;
    return position_ < bytes_.size();
}

std::vector<ExrPartHeader> checkExrParts(std::span<const std::byte> bytes, const fs::path& name) {
    ExrMemoryStream stream(bytes, name.string());
    int version = checkVersion(stream, bytes, name);
    std::vector<ExrPartHeader> parts;
    const uint64_t count = checkLists(bytes, version, name);
    for (uint64_t i = 0; i < count; ++i) {
        ExrPartHeader part;
        part.header.readFrom(stream, version);
        // OpenEXR computes with the windows, and ExrDocument::width() is that of the first part, even if its
        // pixels cannot be read.
        sizeOf(part.header.dataWindow(), name);
        const Size display = sizeOf(part.header.displayWindow(), name);
        checkDimensions(name, display.width, display.height, bytes.size(), maxPixels);
        if (!parts.empty() && part.header.displayWindow() != parts.front().header.displayWindow())
            throw InputError(name, "has parts with different display windows");
        removeMisleading(part.header, version, count == 1);
        part.unreadable = whyUnreadable(part.header, version);
        if (part.unreadable.empty()) part.frame = checkPart(part.header, version, bytes.size(), name);
        parts.push_back(std::move(part));
    }
    checkUnreadable(parts, bytes.size(), name);
    return parts;
}

ExrFrame checkExrHeaders(std::span<const std::byte> bytes, const fs::path& name) {
    ExrMemoryStream stream(bytes, name.string());
    int version = checkVersion(stream, bytes, name);
    checkLists(bytes, version, name);
    Imf::Header header;
    header.readFrom(stream, version);
    const std::string unreadable = whyUnreadable(header, version);
    if (!unreadable.empty()) throw InputError(name, unreadable + ", which is not supported");
    return checkPart(header, version, bytes.size(), name);
}

}  // namespace limpid::image
