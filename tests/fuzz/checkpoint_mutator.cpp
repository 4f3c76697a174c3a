// Mutates a file of sums with libFuzzer, either its header or what follows. Then corrects the length of the
// header, that of the sums and the checksum, which a fuzzer cannot guess.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/hash.h"
#include "renderer/long/sums/accumulation.h"
#include "renderer/long/sums/accumulation_header.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t maxSize);

namespace {

using namespace limpid;
using Bytes = std::vector<uint8_t>;

constexpr size_t prefix = 16, countsSize = 24, hashSize = 8;

struct File {
    Bytes start, header, rest;  ///< magic, version, length; JSON; everything after it except the checksum
};

bool split(const uint8_t* data, size_t size, File& file) {
    uint32_t header = 0;
    if (size < prefix + countsSize + hashSize) return false;
    std::memcpy(&header, data + 12, sizeof header);
    if (header > size - prefix - countsSize - hashSize) return false;
    file.start.assign(data, data + prefix);
    file.header.assign(data + prefix, data + prefix + header);
    file.rest.assign(data + prefix + header, data + size - hashSize);
    return true;
}

void mutate(Bytes& bytes, size_t maxSize) {
    const size_t size = bytes.size();
    if (maxSize == 0) return;
    bytes.resize(std::max(maxSize, size));
    bytes.resize(LLVMFuzzerMutate(bytes.data(), size, bytes.size()));
}

/// Returns the length of `rest` that the header implies, given its block bits; 0 if the header is invalid or
/// implies too much.
size_t lengthOfRest(const File& file, size_t maxSize) {
    try {
        const std::string_view text(reinterpret_cast<const char*>(file.header.data()), file.header.size());
        const AccumulationHeader header = headerFromJson(text, "");
        const FrameSums sums(header.extent, header.plan, header.layers);
        const size_t bits = (sums.blocks.size() + 7) / 8, fixed = countsSize + bits;
        const size_t present = std::min(fixed, std::max(file.rest.size(), countsSize));
        const auto begin = file.rest.begin() + countsSize;
        const auto end = file.rest.begin() + static_cast<std::ptrdiff_t>(present);
        if (std::all_of(begin, end, [](uint8_t byte) { return byte == 0; })) return fixed;
        uint64_t length = fixed;
        for (const LayerSums& layer : sums.layers) length += sums.pixels() * layer.planes() * sizeof(Int128);
        if (sums.wantsIds && (*begin & 1) != 0) length += sums.pixels() * 8;
        return length <= maxSize ? length : 0;
    } catch (const Error&) {
        return 0;
    }
}

size_t join(const File& file, uint8_t* data, size_t maxSize) {
    Bytes bytes = file.start;
    const auto header = static_cast<uint32_t>(file.header.size());
    std::memcpy(&bytes[12], &header, sizeof header);
    bytes.insert(bytes.end(), file.header.begin(), file.header.end());
    bytes.insert(bytes.end(), file.rest.begin(), file.rest.end());
    if (bytes.size() + hashSize > maxSize) return 0;
    Hash64 hash;
    hash.add(std::as_bytes(std::span(bytes)));
    const uint64_t value = hash.value();
    std::copy(bytes.begin(), bytes.end(), data);
    std::memcpy(data + bytes.size(), &value, hashSize);
    return bytes.size() + hashSize;
}

}  // namespace

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t maxSize, unsigned seed) {
    File file;
    // One in eight keeps its damage, since the checks are part of the reader.
    if (seed % 8 == 0 || !split(data, size, file)) return LLVMFuzzerMutate(data, size, maxSize);
    const size_t room = maxSize - size;
    if (seed % 2 == 0) {
        mutate(file.header, file.header.size() + room);
    } else {
        mutate(file.rest, file.rest.size() + room);
        file.rest.resize(std::max(file.rest.size(), countsSize));
    }
    // A few keep a wrong length.
    if (const size_t length = lengthOfRest(file, maxSize); length > 0 && seed % 16 != 1)
        file.rest.resize(length);
    const size_t joined = join(file, data, maxSize);
    return joined > 0 ? joined : size;
}
