#include "image/io/texture/tga_bmp.h"

#include <fmt/format.h>
#include <stb/stb_image.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "base/error.h"
#include "image/io/rows/limits.h"

namespace limpid::image {
namespace {

namespace fs = std::filesystem;
using Bytes = std::span<const std::byte>;

constexpr size_t tgaHeaderBytes = 18;

uint32_t numberAt(Bytes bytes, size_t i) {
    return std::to_integer<uint32_t>(bytes[i]);
}

uint32_t littleEndian16(Bytes bytes, size_t i) {
    return numberAt(bytes, i) | numberAt(bytes, i + 1) << 8;
}

uint32_t littleEndian32(Bytes bytes, size_t i) {
    return littleEndian16(bytes, i) | littleEndian16(bytes, i + 2) << 16;
}

[[noreturn]] void failCutOff(const fs::path& name, const char* format) {
    throw InputError(name, fmt::format("is a {} file that was cut off", format));
}

struct TgaHeader {
    uint32_t kind;  ///< 1 indexed, 2 colour, 3 grey; plus 8: run-length encoded
    uint32_t width, height, bits;
    size_t pixels;  ///< offset of the pixel data

    bool hasRuns() const { return kind >= 8; }
};

TgaHeader tgaHeader(Bytes bytes) {
    const size_t paletteBytes = size_t{littleEndian16(bytes, 5)} * ((numberAt(bytes, 7) + 7) / 8);
    const bool hasPalette = numberAt(bytes, 1) == 1;
    return {numberAt(bytes, 2), littleEndian16(bytes, 12), littleEndian16(bytes, 14), numberAt(bytes, 16),
            tgaHeaderBytes + numberAt(bytes, 0) + (hasPalette ? paletteBytes : 0)};
}

/// Walks the packets: each has a count, and either one pixel to repeat or that many pixels.
void checkRuns(Bytes bytes, const TgaHeader& h, const fs::path& name) {
    const size_t pixelBytes = (h.bits + 7) / 8;
    uint64_t left = uint64_t{h.width} * h.height;
    for (size_t at = h.pixels; left > 0;) {
        if (at >= bytes.size()) failCutOff(name, "TGA");
        const uint32_t packet = numberAt(bytes, at);
        const uint64_t count = (packet & 127) + 1;
        at += 1 + ((packet & 128) != 0 ? pixelBytes : count * pixelBytes);
        if (at > bytes.size()) failCutOff(name, "TGA");
        left -= std::min(left, count);
    }
}

PictureSize checkTga(Bytes bytes, const fs::path& name) {
    const TgaHeader h = tgaHeader(bytes);
    // The best run encodes 128 pixels in two bytes.
    checkDimensions(name, h.width, h.height, bytes.size(), 64);
    if (h.pixels > bytes.size()) failCutOff(name, "TGA");
    if (h.hasRuns()) {
        checkRuns(bytes, h, name);
    } else if (uint64_t{h.width} * h.height * ((h.bits + 7) / 8) > bytes.size() - h.pixels) {
        failCutOff(name, "TGA");
    }
    return {h.width, h.height};
}

PictureSize checkBmp(Bytes bytes, const fs::path& name) {
    const bool isOld = littleEndian32(bytes, 14) == 12;
    if (bytes.size() < (isOld ? 26 : 34)) failCutOff(name, "BMP");
    const uint64_t offset = littleEndian32(bytes, 10);
    const uint64_t width = isOld ? littleEndian16(bytes, 18) : littleEndian32(bytes, 18);
    const uint32_t signedHeight = isOld ? littleEndian16(bytes, 20) : littleEndian32(bytes, 22);
    // A negative height means that the first row is at the top.
    const uint64_t height = signedHeight > 0x7fffffff ? uint64_t{~signedHeight} + 1 : signedHeight;
    const uint64_t bits = littleEndian16(bytes, isOld ? 24 : 28);
    if (!isOld && (littleEndian32(bytes, 30) == 1 || littleEndian32(bytes, 30) == 2))
        throw InputError(name, "is a BMP file packed in runs, which is not supported");
    checkDimensions(name, width, height, bytes.size(), 8);
    const uint64_t rowBytes = (width * bits + 31) / 32 * 4;
    if (offset > bytes.size() || rowBytes * height > bytes.size() - offset) failCutOff(name, "BMP");
    return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

}  // namespace

bool looksLikeTga(Bytes bytes) {
    if (bytes.size() < tgaHeaderBytes) return false;
    const uint32_t palette = numberAt(bytes, 1), kind = numberAt(bytes, 2) & 7, bits = numberAt(bytes, 16);
    if (numberAt(bytes, 2) > 11 || (numberAt(bytes, 2) & 4) != 0 || palette > 1) return false;
    if (kind == 1) return palette == 1 && (bits == 8 || bits == 16);
    if (kind == 2) return bits == 15 || bits == 16 || bits == 24 || bits == 32;
    return kind == 3 && (bits == 8 || bits == 16);
}

bool looksLikeBmp(Bytes bytes) {
    return bytes.size() >= 18 && numberAt(bytes, 0) == 'B' && numberAt(bytes, 1) == 'M';
}

PictureSize checkTgaOrBmp(Bytes bytes, const fs::path& name) {
    if (bytes.size() > static_cast<size_t>(std::numeric_limits<int>::max())) {
        throw InputError(name, fmt::format("is {} bytes long, too much for a picture", bytes.size()));
    }
    return looksLikeBmp(bytes) ? checkBmp(bytes, name) : checkTga(bytes, name);
}

ByteImage decodeTgaOrBmp(Bytes bytes, const fs::path& name) {
    int width = 0, height = 0, components = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()),
                              &width, &height, &components, 4),
        stbi_image_free);
    if (!pixels) throw InputError(name, fmt::format("cannot be decoded: {}", stbi_failure_reason()));
    ByteImage image{static_cast<uint32_t>(width), static_cast<uint32_t>(height), 4, {}};
    image.pixels.assign(pixels.get(), pixels.get() + size_t{image.width} * image.height * 4);
    return image;
}

}  // namespace limpid::image
