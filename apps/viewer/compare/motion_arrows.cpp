#include "viewer/compare/motion_arrows.h"

#include <algorithm>
#include <cmath>

namespace limpid::viewer {
namespace {

constexpr float spacing = 32.0f;
constexpr float minPixels = 0.25f;

}  // namespace

std::vector<Arrow> motionArrows(const image::Image& motion, float windowWidth, float windowHeight) {
    std::vector<Arrow> arrows;
    if (motion.width == 0 || motion.height == 0) return arrows;
    const vec2 scale(windowWidth / static_cast<float>(motion.width),
                     windowHeight / static_cast<float>(motion.height));
    for (float y = 0.5f * spacing; y < windowHeight; y += spacing) {
        for (float x = 0.5f * spacing; x < windowWidth; x += spacing) {
            const uint32_t column = std::min(static_cast<uint32_t>(x / scale.x), motion.width - 1),
                           row = std::min(static_cast<uint32_t>(y / scale.y), motion.height - 1);
            if (motion.components > 3 && motion.at(column, row, 3) <= 0.0f) continue;
            const vec2 back(motion.at(column, row, 0), motion.at(column, row, 1));
            if (!std::isfinite(back.x) || !std::isfinite(back.y) || glm::length(back) < minPixels) continue;
            arrows.push_back({vec2(x, y) + back * scale, vec2(x, y)});
        }
    }
    return arrows;
}

}  // namespace limpid::viewer
