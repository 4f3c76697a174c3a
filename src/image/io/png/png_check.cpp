#include "image/io/png/png_check.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "base/error.h"
#include "image/io/rows/limits.h"

namespace limpid::image {
namespace {

uint8_t byteAt(std::span<const std::byte> bytes, size_t i) {
    return std::to_integer<uint8_t>(bytes[i]);
}

uint32_t bigEndian32(std::span<const std::byte> bytes, size_t i) {
    return uint32_t{byteAt(bytes, i)} << 24 | uint32_t{byteAt(bytes, i + 1)} << 16 |
           uint32_t{byteAt(bytes, i + 2)} << 8 | byteAt(bytes, i + 3);
}

/// Tables of the PNG checksum (ISO 3309, polynomial 0xEDB88320), four bytes at a time.
using CrcTables = std::array<std::array<uint32_t, 256>, 4>;
constexpr CrcTables makeCrcTables() {
    CrcTables tables{};
    for (uint32_t n = 0; n < 256; ++n) {
        uint32_t c = n;
        for (int k = 0; k < 8; ++k) c = (c & 1) ? 0xEDB88320u ^ (c >> 1) : c >> 1;
        tables[0][n] = c;
    }
    for (size_t n = 0; n < 256; ++n) {
        for (size_t t = 1; t < 4; ++t) {
            const uint32_t previous = tables[t - 1][n];
            tables[t][n] = tables[0][previous & 255] ^ (previous >> 8);
        }
    }
    return tables;
}
constexpr CrcTables crcTables = makeCrcTables();

uint32_t crc(std::span<const std::byte> bytes) {
    uint32_t c = 0xFFFFFFFFu;
    size_t i = 0;
    for (; i + 4 <= bytes.size(); i += 4) {
        c ^= uint32_t{byteAt(bytes, i)} | uint32_t{byteAt(bytes, i + 1)} << 8 |
             uint32_t{byteAt(bytes, i + 2)} << 16 | uint32_t{byteAt(bytes, i + 3)} << 24;
        c = crcTables[3][c & 255] ^ crcTables[2][(c >> 8) & 255] ^ crcTables[1][(c >> 16) & 255] ^
            crcTables[0][c >> 24];
    }
    for (; i < bytes.size(); ++i) c = crcTables[0][(c ^ byteAt(bytes, i)) & 255] ^ (c >> 8);
    return c ^ 0xFFFFFFFFu;
}

/// Returns the position after the entropy-coded data that starts at `i`: that of the next real marker.
size_t skipScan(std::span<const std::byte> bytes, size_t i) {
    while (i + 1 < bytes.size()) {
        const uint8_t next = byteAt(bytes, i + 1);
        const bool marker =
            byteAt(bytes, i) == 0xFF && next != 0 && next != 0xFF && !(next >= 0xD0 && next <= 0xD7);
        if (marker) return i;
        ++i;
    }
    return bytes.size();
}

}  // namespace

bool looksLikePng(std::span<const std::byte> bytes) {
    constexpr std::array<uint8_t, 8> signature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    if (bytes.size() < signature.size()) return false;
    return std::equal(signature.begin(), signature.end(), bytes.begin(),
                      [](uint8_t a, std::byte b) { return a == std::to_integer<uint8_t>(b); });
}

bool looksLikeJpeg(std::span<const std::byte> bytes) {
    return bytes.size() >= 3 && byteAt(bytes, 0) == 0xFF && byteAt(bytes, 1) == 0xD8 &&
           byteAt(bytes, 2) == 0xFF;
}

void checkPng(std::span<const std::byte> bytes, const std::filesystem::path& name) {
    size_t i = 8;
    while (bytes.size() - i >= 12) {
        const size_t length = bigEndian32(bytes, i);
        if (length > bytes.size() - i - 12) break;
        if (crc(bytes.subspan(i + 4, length + 4)) != bigEndian32(bytes, i + 8 + length)) {
            throw InputError(name, "is a damaged PNG file: a checksum is wrong");
        }
        constexpr uint32_t ihdr = 0x49484452, iend = 0x49454E44;
        const uint32_t type = bigEndian32(bytes, i + 4);
        if (type == iend) return;
        if (type == ihdr && length >= 8)
            checkDimensions(name, bigEndian32(bytes, i + 8), bigEndian32(bytes, i + 12), bytes.size(),
                            pngPixelsPerByte, maxStreamedPixels);
        i += length + 12;
    }
    throw InputError(name, "is a PNG file that was cut off");
}

bool checkJpeg(std::span<const std::byte> bytes, const std::filesystem::path& name) {
    bool isProgressive = false;
    int scans = 0;
    size_t i = 2;
    while (i + 1 < bytes.size()) {
        if (byteAt(bytes, i) != 0xFF) throw InputError(name, "is a damaged JPEG file");
        const uint8_t marker = byteAt(bytes, i + 1);
        if (marker == 0xFF) {  // fill byte
            ++i;
            continue;
        }
        if (marker == 0xD9) return isProgressive || scans > 1;
        if (marker == 0x01 || (marker >= 0xD0 && marker <= 0xD7)) {  // markers without content
            i += 2;
            continue;
        }
        if (bytes.size() - i < 4) break;
        const size_t length = bigEndian32(bytes, i) & 0xFFFF;
        if (length < 2) throw InputError(name, "is a damaged JPEG file");
        i += 2 + length;
        // Frame headers of the progressive kinds (T.81, table B.1).
        if (marker == 0xC2 || marker == 0xC6 || marker == 0xCA || marker == 0xCE) isProgressive = true;
        if (marker != 0xDA) continue;
        ++scans;
        i = skipScan(bytes, i);
    }
    throw InputError(name, "is a JPEG file that was cut off");
}

}  // namespace limpid::image
