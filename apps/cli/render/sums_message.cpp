#include "cli/render/sums_message.h"

#include <array>
#include <cstring>

#include "base/error.h"

namespace limpid::cli {
namespace {

template <typename T>
void append(std::vector<std::byte>& bytes, std::span<const T> values) {
    const size_t at = bytes.size();
    bytes.resize(at + values.size_bytes());
    if (!values.empty()) std::memcpy(&bytes[at], values.data(), values.size_bytes());
}

template <typename T>
void take(std::span<const std::byte>& bytes, std::span<T> values) {
    if (bytes.size() < values.size_bytes()) throw Error("another process sent sums of another frame");
    std::memcpy(values.data(), bytes.data(), values.size_bytes());
    bytes = bytes.subspan(values.size_bytes());
}

std::vector<uint8_t> flagsOf(const std::vector<bool>& blocks) {
    return {blocks.begin(), blocks.end()};
}

}  // namespace

std::vector<std::byte> encodeCounts(const SampleCounts& counts) {
    const std::array<uint64_t, 3> values{counts.rays, counts.rejected, counts.clamped};
    std::vector<std::byte> bytes;
    append<uint64_t>(bytes, values);
    return bytes;
}

SampleCounts decodeCounts(std::span<const std::byte> bytes) {
    std::array<uint64_t, 3> values{};
    take<uint64_t>(bytes, values);
    return {.rays = values[0], .rejected = values[1], .clamped = values[2]};
}

std::vector<std::byte> encodeSums(const FrameSums& sums) {
    std::vector<std::byte> bytes = encodeCounts(sums.counts);
    size_t size = bytes.size() + sums.blocks.size() + sums.ids.size() * sizeof(uint32_t);
    for (const LayerSums& layer : sums.layers) size += layer.values.size() * sizeof(Int128);
    bytes.reserve(size);
    append<uint8_t>(bytes, flagsOf(sums.blocks));
    for (const LayerSums& layer : sums.layers) append<Int128>(bytes, layer.values);
    append<uint32_t>(bytes, sums.ids);
    return bytes;
}

FrameSums decodeSums(std::span<const std::byte> bytes, FrameSums sums) {
    sums.counts = decodeCounts(bytes);
    bytes = bytes.subspan(3 * sizeof(uint64_t));
    std::vector<uint8_t> flags(sums.blocks.size());
    take<uint8_t>(bytes, flags);
    sums.blocks.assign(flags.begin(), flags.end());
    for (LayerSums& layer : sums.layers) {
        layer.values.resize(sums.pixels() * layer.planes());
        take<Int128>(bytes, layer.values);
    }
    sums.ids.resize(bytes.size() / sizeof(uint32_t));
    if (!sums.ids.empty() && sums.ids.size() != sums.pixels() * 2)
        throw Error("another process sent sums of another frame");
    take<uint32_t>(bytes, sums.ids);
    return sums;
}

}  // namespace limpid::cli
