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

}  // namespace

SequencePicture readSequencePicture(const std::filesystem::path& path) {
    constexpr std::array<uint8_t, 4> exrMagic = {0x76, 0x2f, 0x31, 0x01};
    constexpr std::array<uint8_t, 2> hdrMagic = {'#', '?'};
    const std::vector<std::byte> bytes = readFile(path);
    if (startsWith(bytes, exrMagic)) {
        const LayeredImage layers = decodeExr(bytes, path);
        const auto layer = layers.colorLayer();
        if (!layer) throw InputError(path, "has no layer with the channels R, G and B");
        return {{layers.get(*layer, "RGB"), true}, geometryOf(layers)};
    }
    if (isPfm(bytes)) {
        const Image map = decodePfm(bytes, path);
        Image colors(map.width, map.height, 3);
        for (size_t i = 0; i < colors.pixels.size(); ++i)
            colors.pixels[i] = map.pixels[map.components == 3 ? i : i / 3];
        return {{std::move(colors), true}, {}};
    }
    if (startsWith(bytes, hdrMagic)) return {{decodeHdr(bytes, path), true}, {}};
    return {{linearFromEncoded(decodeImageFloat(bytes, path)), false}, {}};
}

Picture readPicture(const std::filesystem::path& path) {
    return readSequencePicture(path).picture;
}

}  // namespace limpid::image
