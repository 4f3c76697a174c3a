#include "studio/picture.h"

#include <cmath>
#include <glm/gtc/packing.hpp>

#include "image/tone_curve.h"

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

std::vector<uint64_t> extendedTexels(const image::Image& radiance, float stops) {
    const float scale = std::exp2(stops);
    std::vector<uint64_t> texels;
    texels.reserve(size_t{radiance.width} * radiance.height);
    for (size_t at = 0; at + radiance.components <= radiance.pixels.size(); at += radiance.components) {
        const float* const p = &radiance.pixels[at];
        texels.push_back(glm::packHalf4x16(vec4(image::extendedColor(scale * vec3(p[0], p[1], p[2])), 1.0f)));
    }
    return texels;
}

}  // namespace limpid::studio
