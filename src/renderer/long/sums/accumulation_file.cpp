#include "renderer/long/sums/accumulation_file.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <functional>

#include "base/error.h"
#include "base/files/file.h"
#include "base/hash.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "sums are stored as they lie in memory");

constexpr std::array<char, 8> magic{'L', 'I', 'M', 'P', 'I', 'D', 'A', 'C'};
constexpr uint32_t version = 2;
constexpr uint32_t maxHeaderBytes = 1u << 20;

class Writer {
  public:
    explicit Writer(std::ostream& stream) : stream_(stream) {}

    void write(std::span<const std::byte> bytes) {
        hash_.add(bytes);
        stream_.write(reinterpret_cast<const char*>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
    }
    template <typename T>
    void value(const T& v) {
        write(std::as_bytes(std::span<const T, 1>(&v, 1)));
    }
    template <typename T>
    void values(const std::vector<T>& v) {
        write(std::as_bytes(std::span(v)));
    }
    void end() { value(hash_.value()); }

  private:
    std::ostream& stream_;
    Hash64 hash_;
};

/// Fills the bytes with the next data; returns false if there is not enough.
using Source = std::function<bool(std::span<std::byte>)>;

class Reader {
  public:
    Reader(Source source, uint64_t bytes, const fs::path& name)
        : source_(std::move(source)), left_(bytes), name_(name) {}

    uint64_t left() const { return left_; }
    [[noreturn]] void fail(const std::string& fault) const { throw InputError(name_, fault); }

    void read(std::span<std::byte> bytes) {
        if (bytes.size() > left_) fail("ends too early");
        if (!source_(bytes)) fail("cannot be read to its end");
        left_ -= bytes.size();
        hash_.add(bytes);
    }
    template <typename T>
    T value() {
        T v{};
        read(std::as_writable_bytes(std::span<T, 1>(&v, 1)));
        return v;
    }
    template <typename T>
    void values(std::vector<T>& v) {
        read(std::as_writable_bytes(std::span(v)));
    }
    void end() {
        const uint64_t expected = hash_.value();
        if (value<uint64_t>() != expected) fail("is damaged: its checksum is wrong");
    }

  private:
    Source source_;
    uint64_t left_;
    const fs::path& name_;
    Hash64 hash_;
};

/// The size of everything after the blocks: sums, ids, checksum.
uint64_t bytesAfterBlocks(const FrameSums& sums, bool ids) {
    uint64_t bytes = sizeof(uint64_t);
    if (sums.blockCount() == 0) return bytes;
    for (const LayerSums& layer : sums.layers) bytes += sums.pixels() * layer.planes() * sizeof(Int128);
    return ids ? bytes + sums.pixels() * 2 * sizeof(uint32_t) : bytes;
}

std::vector<uint8_t> bitsOf(const std::vector<bool>& blocks) {
    std::vector<uint8_t> bits((blocks.size() + 7) / 8);
    for (size_t b = 0; b < blocks.size(); ++b) {
        if (blocks[b]) bits[b / 8] = static_cast<uint8_t>(bits[b / 8] | 1u << (b % 8));
    }
    return bits;
}

void readBlocks(Reader& reader, std::vector<bool>& blocks) {
    std::vector<uint8_t> bits((blocks.size() + 7) / 8);
    reader.values(bits);
    for (size_t b = 0; b < bits.size() * 8; ++b) {
        const bool in = (bits[b / 8] >> (b % 8) & 1) != 0;
        if (b < blocks.size()) {
            blocks[b] = in;
        } else if (in) {
            reader.fail("names a block that the render does not have");
        }
    }
}

AccumulationHeader readHeader(Reader& reader, const fs::path& name) {
    if (reader.left() < magic.size() + 8) reader.fail("is no file of sums: too short");
    if (reader.value<std::array<char, 8>>() != magic) reader.fail("is no file of sums");
    const auto fileVersion = reader.value<uint32_t>();
    if (fileVersion != version) {
        reader.fail(
            fmt::format("has format version {}; this program reads version {}", fileVersion, version));
    }
    const auto bytes = reader.value<uint32_t>();
    if (bytes > reader.left()) reader.fail("ends too early");
    if (bytes > maxHeaderBytes) reader.fail("has a damaged header");
    std::string text(bytes, '\0');
    reader.read(std::as_writable_bytes(std::span(text)));
    return headerFromJson(text, name);
}

SampleCounts readCounts(Reader& reader) {
    SampleCounts counts;
    counts.rays = reader.value<uint64_t>();
    counts.rejected = reader.value<uint64_t>();
    counts.clamped = reader.value<uint64_t>();
    return counts;
}

/// Reads everything after the blocks except the checksum.
void readSums(Reader& reader, FrameSums& sums) {
    const bool ids = sums.wantsIds && sums.blocks[0];
    // Memory is only allocated now, when the file's length matches it.
    if (reader.left() != bytesAfterBlocks(sums, ids)) reader.fail("has another length than its header says");
    if (sums.blockCount() == 0) return;
    for (LayerSums& layer : sums.layers) {
        layer.values.resize(sums.pixels() * layer.planes());
        reader.values(layer.values);
    }
    if (!ids) return;
    sums.ids.resize(sums.pixels() * 2);
    reader.values(sums.ids);
}

Accumulation readFrom(Reader reader, const fs::path& name) {
    AccumulationHeader header = readHeader(reader, name);
    FrameSums sums(header.extent, header.plan, header.layers);
    sums.counts = readCounts(reader);
    readBlocks(reader, sums.blocks);
    for (uint32_t block = 0; header.frames == 1 && block < sums.blocks.size(); ++block) {
        if (sums.blocks[block] && !header.shard.has(block)) reader.fail("has a block that its shard lacks");
    }
    readSums(reader, sums);
    reader.end();
    return {std::move(header), std::move(sums)};
}

void writeTo(std::ostream& stream, const AccumulationHeader& header, const FrameSums& sums) {
    const std::string text = toJson(header);
    if (text.size() > maxHeaderBytes) throw Error("the header of a file of sums is too long");
    Writer writer(stream);
    writer.value(magic);
    writer.value(version);
    writer.value(static_cast<uint32_t>(text.size()));
    writer.write(std::as_bytes(std::span(text)));
    writer.value(sums.counts.rays);
    writer.value(sums.counts.rejected);
    writer.value(sums.counts.clamped);
    writer.values(bitsOf(sums.blocks));
    if (sums.blockCount() > 0) {
        for (const LayerSums& layer : sums.layers) writer.values(layer.values);
        if (sums.wantsIds && sums.blocks[0]) writer.values(sums.ids);
    }
    writer.end();
}

void check(const AccumulationHeader& header, const FrameSums& sums) {
    const bool ids = sums.wantsIds && sums.blocks.at(0);
    if (sums.extent != header.extent || sums.plan != header.plan || sums.partSamples > 0 ||
        (ids && sums.ids.size() != sums.pixels() * 2)) {
        throw Error("the sums do not fit the header of their file");
    }
}

}  // namespace

void writeAccumulation(const fs::path& path, const AccumulationHeader& header, const FrameSums& sums) {
    check(header, sums);
    writeAtomically(path, [&](const fs::path& temporary) {
        std::ofstream file(temporary, std::ios::binary);
        writeTo(file, header, sums);
        file.close();
        if (!file) throw OutputError(path, "cannot be written: the disk may be full");
    });
}

Accumulation readAccumulation(const fs::path& path) {
    if (const auto fault = irregularity(path)) throw InputError(path, *fault);
    std::ifstream stream(path, std::ios::binary | std::ios::ate);
    if (!stream) throw InputError(path, "cannot be opened");
    const std::streamoff size = stream.tellg();
    stream.seekg(0);
    if (size < 0 || !stream) throw InputError(path, "cannot be read");
    const Source source = [&](std::span<std::byte> bytes) {
        stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        return static_cast<size_t>(stream.gcount()) == bytes.size();
    };
    return readFrom(Reader(source, static_cast<uint64_t>(size), path), path);
}

Accumulation decodeAccumulation(std::span<const std::byte> bytes, const fs::path& name) {
    std::span<const std::byte> rest = bytes;
    const Source source = [&](std::span<std::byte> out) {
        if (out.size() > rest.size()) return false;
        if (!out.empty()) std::memcpy(out.data(), rest.data(), out.size());
        rest = rest.subspan(out.size());
        return true;
    };
    return readFrom(Reader(source, bytes.size(), name), name);
}

}  // namespace limpid
