#include <utility>

#include "image/io/png/png.h"
#include "image/io/texture/texture_decode.h"
#include "scene/device/mip_levels.h"
#include "scratch.h"

namespace limpid::fuzz {

bool png(Bytes input) {
    // From memory, as OBJ's maps are decoded (glTF's are the same without TGA and BMP), with a limit that
    // makes larger ones be scaled down.
    image::ByteImage bytes;
    const image::TextureDecoding how{.tgaAndBmp = true, .maxMemory = uint64_t{1} << 25};
    const bool asTexture = accepts([&] { bytes = image::decodeTexture(input, "a.png", how); });
    if (asTexture) {
        scene::Texture texture;
        texture.width = bytes.width;
        texture.height = bytes.height;
        texture.rgba = std::move(bytes.pixels);
        scene::withMipLevels(texture);
    }
    // And as `limpid compare` reads pictures.
    const bool accepted = accepts([&] { image::decodeImage(input, "a.png"); });
    const bool asFloats = accepts([&] { image::decodeImageFloat(input, "a.png"); });
    if (accepted != asFloats) throw Error("8 bits and float disagree on whether the picture can be read");
    return accepted || asTexture;
}

}  // namespace limpid::fuzz
