// Applies libFuzzer's mutations, then corrects the checksums of a PNG's chunks: the reader rejects wrong ones
// immediately, and a fuzzer cannot guess correct ones.
#include <cstdint>
#include <cstring>

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t maxSize);

namespace {

/// ISO 3309, bit by bit.
uint32_t crc(const uint8_t* bytes, size_t size) {
    uint32_t c = 0xFFFFFFFFu;
    for (size_t i = 0; i < size; ++i) {
        c ^= bytes[i];
        for (int k = 0; k < 8; ++k) c = (c & 1) ? 0xEDB88320u ^ (c >> 1) : c >> 1;
    }
    return ~c;
}

void repairChecksums(uint8_t* data, size_t size) {
    size_t i = 8;
    while (size >= i + 12) {
        const size_t length = uint32_t{data[i]} << 24 | data[i + 1] << 16 | data[i + 2] << 8 | data[i + 3];
        if (length > size - i - 12) return;
        const uint32_t sum = crc(data + i + 4, length + 4);
        for (size_t k = 0; k < 4; ++k) data[i + 8 + length + k] = static_cast<uint8_t>(sum >> (24 - 8 * k));
        i += length + 12;
    }
}

}  // namespace

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t maxSize, unsigned seed) {
    const size_t mutated = LLVMFuzzerMutate(data, size, maxSize);
    // One in eight keeps its damage, since the check is part of the reader.
    if (seed % 8 != 0 && mutated > 8 && data[1] == 'P') repairChecksums(data, mutated);
    return mutated;
}
