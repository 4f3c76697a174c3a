#include "image/io/exr/exr_rows.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "base/error.h"
#include "image/image.h"
#include "image/io/exr/exr_header.h"

namespace limpid::image {
namespace {

namespace fs = std::filesystem;
using Names = std::array<std::string, 3>;

Names colorChannels(const Imf::Header& header, const fs::path& name) {
    LayeredImage names;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it)
        names.channels.push_back({it.name(), Storage::Float, {}});
    if (const auto layer = names.colorLayer()) {
        const std::string prefix = layer->empty() ? "" : *layer + ".";
        return {prefix + "R", prefix + "G", prefix + "B"};
    }
    if (names.find("Y")) return {"Y", "Y", "Y"};
    throw InputError(name, "has no layer with the channels R, G and B");
}

/// How rows are decoded: rows per band, number of threads, and bytes of buffers.
struct Plan {
    int rows = 1, threads = 0;
    uint64_t memory = 0;
};

Plan planFor(const ExrFrame& frame, uint64_t maxMemory) {
    const auto width = static_cast<uint64_t>(frame.data.max.x - frame.data.min.x) + 1;
    const auto chunkRows = static_cast<uint64_t>(frame.rowsPerChunk);
    // OpenEXR uses two buffers per thread, for a packed and an unpacked chunk. We store the rows as floats;
    // for tiled files, OpenEXR does too.
    const uint64_t buffer = 2 * width * chunkRows * frame.bytesPerPixel;
    const uint64_t floats = 2 * width * 3 * sizeof(float);
    const auto wanted = static_cast<uint64_t>(std::max(Imf::globalThreadCount(), 0));
    const uint64_t threads = std::min(wanted, maxMemory / 4 / (2 * buffer));
    const uint64_t chunks =
        std::clamp<uint64_t>(maxMemory / 8 / (floats * chunkRows), 1, std::max<uint64_t>(threads, 1));
    const auto height = static_cast<uint64_t>(frame.data.max.y - frame.data.min.y) + 1;
    const uint64_t rows = std::min(chunks * chunkRows, height);
    return {
        static_cast<int>(rows), static_cast<int>(threads),
        std::max<uint64_t>(2 * threads, 1) * buffer + floats * std::max(rows, std::min(chunkRows, height))};
}

/// A band of rows of the data window, three floats per pixel.
class ColorBand {
  public:
    ColorBand(const Imath::Box2i& data, const Names& names, int rows)
        : data_(data), names_(names), width_(static_cast<size_t>(data.max.x - data.min.x) + 1) {
        values_.resize(width_ * static_cast<size_t>(rows) * 3);
    }

    void read(Imf::InputPart& part, int first, int last) {
        first_ = first;
        Imf::FrameBuffer frame;
        // EXR addresses pixels by absolute coordinates: see Band in exr_read.cpp.
        const auto width = static_cast<intptr_t>(width_);
        const intptr_t origin = reinterpret_cast<intptr_t>(values_.data()) -
                                12 * (intptr_t{data_.min.x} + intptr_t{first} * width);
        const bool isGrey = names_[0] == names_[1];
        for (size_t c = 0; c < (isGrey ? 1 : 3); ++c) {
            auto* base = reinterpret_cast<char*>(origin + static_cast<intptr_t>(4 * c));
            frame.insert(names_[c], Imf::Slice(Imf::FLOAT, base, 12, 12 * width_));
        }
        part.setFrameBuffer(frame);
        part.readPixels(first, last);
        if (!isGrey) return;
        const size_t count = width_ * static_cast<size_t>(last - first + 1);
        for (size_t i = 0; i < count; ++i) values_[3 * i + 1] = values_[3 * i + 2] = values_[3 * i];
    }

    /// Copies the part of row y that is inside the frame.
    void copyRow(const Imath::Box2i& display, int y, std::span<float> row) const {
        const int left = std::max(data_.min.x, display.min.x), right = std::min(data_.max.x, display.max.x);
        if (left > right) return;
        const size_t from =
            static_cast<size_t>(y - first_) * width_ + static_cast<size_t>(left - data_.min.x);
        std::copy_n(&values_[from * 3], 3 * (static_cast<size_t>(right - left) + 1),
                    &row[static_cast<size_t>(left - display.min.x) * 3]);
    }

  private:
    Imath::Box2i data_;
    Names names_;
    size_t width_;
    int first_ = 0;
    std::vector<float> values_;
};

void decode(std::span<const std::byte> bytes, const fs::path& name, const RowSink& sink, uint64_t maxMemory) {
    const ExrFrame frame = checkExrHeaders(bytes, name);
    useExrThreads();
    const Plan plan = planFor(frame, maxMemory);
    ExrMemoryStream stream(bytes, name.string());
    // The library allocates its buffers when it opens the file.
    sink.begin({frame.width(), frame.height()}, plan.memory);
    Imf::MultiPartInputFile file(stream, plan.threads, false);
    Imf::InputPart part(file, 0);
    ColorBand band(frame.data, colorChannels(part.header(), name), plan.rows);
    std::vector<float> row(size_t{frame.width()} * 3);
    int read = frame.data.min.y;  // the first row of the data window that is not yet read
    for (int y = frame.display.min.y; y <= frame.display.max.y; ++y) {
        std::fill(row.begin(), row.end(), 0.0f);
        const bool isStored = y >= frame.data.min.y && y <= frame.data.max.y;
        while (isStored && read <= y) {
            const int last = std::min(read + plan.rows - 1, frame.data.max.y);
            if (last >= y) band.read(part, read, last);  // otherwise the band lies above the frame
            read = last + 1;
        }
        if (isStored) band.copyRow(frame.display, y, row);
        sink.row(static_cast<uint32_t>(y - frame.display.min.y), row);
    }
}

}  // namespace

void decodeExrRows(std::span<const std::byte> bytes, const fs::path& name, const RowSink& sink,
                   uint64_t maxMemory) {
    readingExr(name, [&] { decode(bytes, name, sink, maxMemory); });
}

}  // namespace limpid::image
