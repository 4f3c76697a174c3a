#include "image/io/picture.h"

#include <array>
#include <cstddef>
#include <span>

#include "base/error.h"
#include "base/files/file.h"
#include "image/color.h"
#include "image/io/exr/exr.h"
#include "image/io/hdr.h"
#include "image/io/pfm.h"
#include "image/io/png/png.h"
#include "image/io/png/png_check.h"

namespace limpid::image {
namespace {

bool startsWith(std::span<const std::byte> bytes, std::span<const uint8_t> magic) {
    if (bytes.size() < magic.size()) return false;
    for (size_t i = 0; i < magic.size(); ++i) {
        if (std::to_integer<uint8_t>(bytes[i]) != magic[i]) return false;
    }
    return true;
}

Image linearFromEncoded(const Image& encoded) {
    Image linear(encoded.width, encoded.height, 3);
    for (size_t i = 0; i < linear.pixels.size(); ++i) {
        linear.pixels[i] = srgbDecode(encoded.pixels[i / 3 * encoded.components + i % 3]);
    }
    return linear;
}

SequencePicture decodeExrPicture(std::span<const std::byte> bytes, const std::filesystem::path& name) {
    const LayeredImage layers = decodeExr(bytes, name);
    const auto layer = layers.colorLayer();
    if (!layer) throw InputError(name, "has no layer with the channels R, G and B");
    return {{layers.get(*layer, "RGB"), true}, geometryOf(layers)};
}

Image decodePfmColors(std::span<const std::byte> bytes, const std::filesystem::path& name) {
    const Image map = decodePfm(bytes, name);
    Image colors(map.width, map.height, 3);
    for (size_t i = 0; i < colors.pixels.size(); ++i)
        colors.pixels[i] = map.pixels[map.components == 3 ? i : i / 3];
    return colors;
}

SequencePicture decodeSequencePicture(std::span<const std::byte> bytes, const std::filesystem::path& name) {
    switch (formatOf(bytes)) {
        case PictureFormat::Exr:
            return decodeExrPicture(bytes, name);
        case PictureFormat::Pfm:
            return {{decodePfmColors(bytes, name), true}, {}};
        case PictureFormat::Hdr:
            return {{decodeHdr(bytes, name), true}, {}};
        case PictureFormat::Png:
        case PictureFormat::Jpeg:
        case PictureFormat::Unknown:  // the error says how the file begins
            break;
    }
    return {{linearFromEncoded(decodeImageFloat(bytes, name)), false}, {}};
}

}  // namespace

PictureFormat formatOf(std::span<const std::byte> bytes) {
    constexpr std::array<uint8_t, 4> exrMagic = {0x76, 0x2f, 0x31, 0x01};
    constexpr std::array<uint8_t, 2> hdrMagic = {'#', '?'};
    if (startsWith(bytes, exrMagic)) return PictureFormat::Exr;
    if (isPfm(bytes)) return PictureFormat::Pfm;
    if (startsWith(bytes, hdrMagic)) return PictureFormat::Hdr;
    if (looksLikePng(bytes)) return PictureFormat::Png;
    return looksLikeJpeg(bytes) ? PictureFormat::Jpeg : PictureFormat::Unknown;
}

SequencePicture readSequencePicture(const std::filesystem::path& path) {
    return decodeSequencePicture(readFile(path), path);
}

Picture readPicture(const std::filesystem::path& path) {
    return readSequencePicture(path).picture;
}

Picture decodePicture(std::span<const std::byte> bytes, const std::filesystem::path& name) {
    return decodeSequencePicture(bytes, name).picture;
}

}  // namespace limpid::image
