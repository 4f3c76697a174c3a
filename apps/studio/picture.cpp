#include "studio/picture.h"

namespace limpid::studio {

std::vector<uint32_t> packedTexels(const image::ByteImage& bytes) {
    std::vector<uint32_t> texels;
    texels.reserve(size_t{bytes.width} * bytes.height);
    for (size_t at = 0; at + bytes.components <= bytes.pixels.size(); at += bytes.components) {
        const uint8_t* const pixel = &bytes.pixels[at];
        const uint32_t alpha = bytes.components == 4 ? pixel[3] : 255u;
        texels.push_back(uint32_t{pixel[0]} | uint32_t{pixel[1]} << 8 | uint32_t{pixel[2]} << 16 |
                         alpha << 24);
    }
    return texels;
}

}  // namespace limpid::studio
