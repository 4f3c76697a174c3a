#include "image/io/hdr.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

#include "base/error.h"
#include "base/files/file.h"
#include "base/files/file_kind.h"
#include "image/io/rows/limits.h"

namespace limpid::image {
namespace {

namespace fs = std::filesystem;
using Rgbe = std::array<uint8_t, 4>;

/// Reads bytes sequentially; every read is checked.
class Reader {
  public:
    Reader(std::span<const std::byte> bytes, const fs::path& name) : bytes_(bytes), name_(name) {}

    [[noreturn]] void fail(const std::string& fault) const { throw InputError(name_, fault); }
    uint8_t byte() {
        if (position_ >= bytes_.size()) fail("is a Radiance picture that was cut off");
        return std::to_integer<uint8_t>(bytes_[position_++]);
    }
    Rgbe rgbe() {
        Rgbe value{};
        for (uint8_t& component : value) component = byte();
        return value;
    }
    std::string line() {
        std::string text;
        while (true) {
            const char c = static_cast<char>(byte());
            if (c == '\n') break;
            text += c;
            if (text.size() > 4096) fail("has a header line without end");
        }
        if (text.ends_with('\r')) text.pop_back();
        return text;
    }

  private:
    std::span<const std::byte> bytes_;
    const fs::path& name_;
    size_t position_ = 0;
};

struct Header {
    uint32_t width = 0;
    uint32_t height = 0;
    bool bottomUp = false;
    double exposure = 1.0;
};

double parseExposure(const Reader& reader, std::string_view text) {
    while (text.starts_with(' ')) text.remove_prefix(1);
    double value = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    if (!(value > 0.0) || !std::isfinite(value)) reader.fail("has an EXPOSURE that is no positive number");
    return value;
}

/// Parses a line such as "-Y 512 +X 1024".
void parseResolution(const Reader& reader, std::string_view text, Header& header) {
    const auto number = [&](std::string_view label) {
        if (!text.starts_with(label)) reader.fail("has no resolution line of the form '-Y height +X width'");
        text.remove_prefix(label.size());
        uint32_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc{}) reader.fail("has no readable resolution");
        text.remove_prefix(static_cast<size_t>(end - text.data()));
        return value;
    };
    header.bottomUp = text.starts_with("+Y ");
    header.height = number(header.bottomUp ? "+Y " : "-Y ");
    header.width = number(" +X ");
}

Header readHeader(Reader& reader) {
    reader.line();  // "#?RADIANCE", or a program's name
    Header header;
    while (true) {
        const std::string line = reader.line();
        if (line.empty()) break;
        if (line.starts_with("EXPOSURE="))
            header.exposure *= parseExposure(reader, std::string_view(line).substr(9));
        if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe") {
            reader.fail(fmt::format("has the unsupported {}", line));
        }
    }
    if (!(header.exposure > 0.0) || !std::isfinite(header.exposure))
        reader.fail("its EXPOSURE values multiply to zero or infinity");
    parseResolution(reader, reader.line(), header);
    return header;
}

/// Per-component runs: a count above 128 repeats one byte; otherwise that many bytes follow.
void readNewRow(Reader& reader, std::span<Rgbe> row) {
    for (size_t c = 0; c < 4; ++c) {
        size_t x = 0;
        while (x < row.size()) {
            const uint8_t code = reader.byte();
            const bool run = code > 128;
            const size_t count = run ? code - 128u : code;
            if (count == 0 || count > row.size() - x) reader.fail("is a damaged Radiance picture");
            uint8_t value = 0;
            for (size_t i = 0; i < count; ++i) {
                if (!run || i == 0) value = reader.byte();
                row[x++][c] = value;
            }
        }
    }
}

/// Uncompressed pixels, where (1,1,1,n) repeats the previous pixel n times; consecutive ones give higher
/// bytes of n.
void readOldRow(Reader& reader, std::span<Rgbe> row, Rgbe first) {
    size_t x = 0;
    unsigned shift = 0;
    Rgbe pixel = first;
    while (true) {
        if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
            const size_t count = size_t{pixel[3]} << shift;
            if (x == 0 || shift > 16 || count > row.size() - x) reader.fail("is a damaged Radiance picture");
            std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(x), count, row[x - 1]);
            x += count;
            shift += 8;
        } else {
            row[x++] = pixel;
            shift = 0;
        }
        if (x == row.size()) return;
        pixel = reader.rgbe();
    }
}

void readRow(Reader& reader, std::span<Rgbe> row) {
    const Rgbe first = reader.rgbe();
    const bool marked = first[0] == 2 && first[1] == 2 && first[2] < 128;
    if (marked && row.size() >= 8 && row.size() < 32768) {
        if ((size_t{first[2]} << 8 | first[3]) != row.size()) reader.fail("has a row of another width");
        readNewRow(reader, row);
    } else {
        readOldRow(reader, row, first);
    }
}

void convertRow(std::span<const Rgbe> row, double exposure, std::span<float> target) {
    for (size_t x = 0; x < row.size(); ++x) {
        const double scale = row[x][3] == 0 ? 0.0 : std::ldexp(1.0, int{row[x][3]} - 136) / exposure;
        for (size_t c = 0; c < 3; ++c) target[3 * x + c] = static_cast<float>(row[x][c] * scale);
    }
}

}  // namespace

void decodeHdrRows(std::span<const std::byte> bytes, const fs::path& name, const RowSink& sink,
                   uint64_t most) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!text.starts_with("#?"))
        throw InputError(name, "is no Radiance picture: " + describeBeginning(bytes));
    Reader reader(bytes, name);
    const Header header = readHeader(reader);
    // Old runs have no fixed limit; the best case, a row of one colour, takes about 12 bytes.
    checkDimensions(name, header.width, header.height, bytes.size(), 512, most);
    sink.begin({header.width, header.height}, uint64_t{header.width} * (sizeof(Rgbe) + 3 * sizeof(float)));
    std::vector<Rgbe> row(header.width);
    std::vector<float> values(size_t{header.width} * 3);
    for (uint32_t i = 0; i < header.height; ++i) {
        readRow(reader, row);
        convertRow(row, header.exposure, values);
        sink.row(header.bottomUp ? header.height - 1 - i : i, values);
    }
}

Image decodeHdr(std::span<const std::byte> bytes, const fs::path& name) {
    Image image;
    const auto begin = [&](PictureSize size, uint64_t) { image = Image(size.width, size.height, 3); };
    const auto take = [&](uint32_t y, std::span<float> row) {
        std::copy(row.begin(), row.end(), image.pixels.begin() + static_cast<std::ptrdiff_t>(y * row.size()));
    };
    decodeHdrRows(bytes, name, {begin, take}, maxPixels);
    return image;
}

Image readHdr(const fs::path& path) {
    return decodeHdr(readFile(path), path);
}

}  // namespace limpid::image
