#include <utility>

#include "image/png.h"
#include "scene/mip_levels.h"
#include "scratch.h"

namespace limpid::fuzz {

bool png(Bytes input) {
    // From memory, as glTF's images and OBJ's maps reach the decoder.
    image::ByteImage bytes;
    const bool accepted = accepts([&] { bytes = image::decodeImage(input, "a.png"); });
    if (accepted) {
        scene::Texture texture;
        texture.width = bytes.width;
        texture.height = bytes.height;
        texture.rgba = std::move(bytes.pixels);
        scene::withMipLevels(texture);
    }
    // And as `limpid compare` reads pictures.
    const bool asFloats = accepts([&] { image::decodeImageFloat(input, "a.png"); });
    if (accepted != asFloats) throw Error("8 bits and float disagree on whether the picture can be read");
    return accepted;
}

}  // namespace limpid::fuzz
