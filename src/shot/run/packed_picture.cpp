#include "shot/run/packed_picture.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "shot/frame/pixel_layers.h"

namespace limpid::shot {
namespace {

/// True if half precision can keep the pixel's colour.
bool fits(const float* color) {
    return std::all_of(color, color + 3, [](float value) { return std::abs(value) <= largestHalf; });
}

}  // namespace

PackedPicture::PackedPicture(const CleanPicture& picture) {
    colors_.reserve(picture.beauty.size() / 4 * 3);
    for (size_t i = 0; i < picture.beauty.size(); ++i)
        if (i % 4 != 3)
            colors_.push_back(glm::packHalf1x16(std::clamp(picture.beauty[i], -largestHalf, largestHalf)));
    for (const float share : picture.alpha) alpha_.push_back(glm::packHalf1x16(share));
    for (size_t p = 0; p < picture.frames.size(); ++p) {
        const float count = fits(&picture.beauty[4 * p]) ? picture.frames[p] : 0.0f;
        frames_.push_back(static_cast<uint8_t>(std::clamp(count, 0.0f, 255.0f)));
    }
}

CleanPicture PackedPicture::unpacked() const {
    CleanPicture picture;
    picture.beauty.resize(colors_.size() / 3 * 4);
    for (size_t i = 0; i < colors_.size(); ++i)
        picture.beauty[i / 3 * 4 + i % 3] = glm::unpackHalf1x16(colors_[i]);
    for (const uint16_t share : alpha_) picture.alpha.push_back(glm::unpackHalf1x16(share));
    picture.frames.assign(frames_.begin(), frames_.end());
    return picture;
}

}  // namespace limpid::shot
