#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <memory>
#include <string_view>

#include "base/error.h"
#include "base/files/file.h"
#include "image/io/exr/exr.h"
#include "image/io/exr/exr_header.h"

namespace limpid::image {
namespace {

/// Returns all channels without values. Memory is only reserved, so that a damaged file's claims do not use
/// any.
LayeredImage emptyImage(const ExrFrame& frame, const Imf::Header& header) {
    LayeredImage image;
    image.width = frame.width();
    image.height = frame.height();
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        Channel channel{it.name(), Storage::Float, {}};
        channel.values.reserve(size_t{image.width} * image.height);
        if (it.channel().type == Imf::HALF) channel.storage = Storage::Half;
        if (it.channel().type == Imf::UINT) channel.storage = Storage::Uint;
        image.channels.push_back(std::move(channel));
    }
    for (auto it = header.begin(); it != header.end(); ++it) {
        const std::string_view name = it.name();
        if (name == "name" || name == "type" || name == "view") continue;  // describes parts, not the picture
        const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
        if (text) image.metadata[it.name()] = text->value();
    }
    return image;
}

/// Existing rows keep their values; new ones are 0.
void growTo(LayeredImage& image, int rows) {
    for (Channel& channel : image.channels)
        channel.values.resize(size_t{image.width} * static_cast<size_t>(rows));
}

/// Whole chunks of rows, decoded at the data window's full width, with one plane of 32-bit words per channel.
class Band {
  public:
    Band(const Imath::Box2i& data, int rows, size_t channels)
        : data_(data), width_(static_cast<size_t>(data.max.x - data.min.x) + 1), planes_(channels) {
        // Not initialised: decoding fills them, and if it fails the memory is never touched.
        for (auto& plane : planes_)
            plane = std::make_unique_for_overwrite<uint32_t[]>(width_ * static_cast<size_t>(rows));
    }

    /// Decodes rows first..last of the file, in its own coordinates.
    void read(Imf::InputPart& part, const LayeredImage& image, int first, int last) {
        first_ = first;
        Imf::FrameBuffer frame;
        for (size_t c = 0; c < planes_.size(); ++c) {
            // EXR addresses pixels by absolute coordinates, so its base pointer lies outside the plane. We
            // compute it as an integer, because such a pointer is undefined in C++.
            const auto base = reinterpret_cast<intptr_t>(planes_[c].get());
            const auto width = static_cast<intptr_t>(width_);
            const intptr_t origin = base - 4 * (intptr_t{data_.min.x} + intptr_t{first} * width);
            const Imf::PixelType type = image.channels[c].storage == Storage::Uint ? Imf::UINT : Imf::FLOAT;
            frame.insert(image.channels[c].name,
                         Imf::Slice(type, reinterpret_cast<char*>(origin), 4, 4 * width_));
        }
        part.setFrameBuffer(frame);
        part.readPixels(first, last);
    }

    /// Copies the pixels of row y that are in both windows.
    void copyRow(LayeredImage& image, const Imath::Box2i& display, int y) const {
        const int left = std::max(data_.min.x, display.min.x);
        const int right = std::min(data_.max.x, display.max.x);
        const size_t from = static_cast<size_t>(y - first_) * width_;
        const size_t to = static_cast<size_t>(y - display.min.y) * image.width;
        for (size_t c = 0; c < planes_.size(); ++c) {
            Channel& channel = image.channels[c];
            const bool isUint = channel.storage == Storage::Uint;
            for (int x = left; x <= right; ++x) {
                const uint32_t word = planes_[c][from + static_cast<size_t>(x - data_.min.x)];
                channel.values[to + static_cast<size_t>(x - display.min.x)] =
                    isUint ? static_cast<float>(word) : std::bit_cast<float>(word);
            }
        }
    }

  private:
    Imath::Box2i data_;
    size_t width_;
    int first_ = 0;
    std::vector<std::unique_ptr<uint32_t[]>> planes_;
};

void readPixels(Imf::InputPart& part, const ExrFrame& frame, LayeredImage& image) {
    const Imath::Box2i& data = frame.data;
    const int height = data.max.y - data.min.y + 1;
    // A band holds whole chunks (and rows of tiles), so that none is decoded twice.
    const int wanted = (256 + frame.rowsPerChunk - 1) / frame.rowsPerChunk * frame.rowsPerChunk;
    const int bandRows = std::min(wanted, height);
    Band band(data, bandRows, image.channels.size());
    for (int first = data.min.y; first <= data.max.y; first += bandRows) {
        const int last = std::min(first + bandRows - 1, data.max.y);
        const int top = std::max(first, frame.display.min.y);
        const int bottom = std::min(last, frame.display.max.y);
        if (top > bottom) continue;  // overscan rows
        band.read(part, image, first, last);
        growTo(image, bottom - frame.display.min.y + 1);
        for (int y = top; y <= bottom; ++y) band.copyRow(image, frame.display, y);
    }
    growTo(image, frame.display.max.y - frame.display.min.y + 1);
}

LayeredImage decode(std::span<const std::byte> bytes, const std::filesystem::path& name) {
    const ExrFrame frame = checkExrHeaders(bytes, name);
    useExrThreads();
    ExrMemoryStream stream(bytes, name.string());
    // Do not reconstruct a damaged chunk table: an incomplete file is an error, not a picture with holes.
    Imf::MultiPartInputFile file(stream, Imf::globalThreadCount(), false);
    Imf::InputPart part(file, 0);
    LayeredImage image = emptyImage(frame, part.header());
    readPixels(part, frame, image);
    return image;
}

}  // namespace

LayeredImage decodeExr(std::span<const std::byte> bytes, const std::filesystem::path& name) {
    return readingExr(name, [&] { return decode(bytes, name); });
}

LayeredImage readExr(const std::filesystem::path& path) {
    return decodeExr(readFile(path), path);
}

}  // namespace limpid::image
