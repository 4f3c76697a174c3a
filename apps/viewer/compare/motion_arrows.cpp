#include "viewer/compare/motion_arrows.h"

#include <algorithm>

#include "studio/compare/motion_sample.h"

namespace limpid::viewer {
namespace {

constexpr float spacing = 32.0f;
constexpr float shortestHead = 5.0f, longestHead = 9.0f, headShare = 0.4f;  ///< the last: of the arrow

}  // namespace

std::vector<Arrow> motionArrows(const image::Image& motion, float windowWidth, float windowHeight) {
    std::vector<Arrow> arrows;
    if (motion.width == 0 || motion.height == 0) return arrows;
    const vec2 window(windowWidth, windowHeight), scale = window / vec2(motion.width, motion.height);
    for (float y = 0.5f * spacing; y < windowHeight; y += spacing) {
        for (float x = 0.5f * spacing; x < windowWidth; x += spacing) {
            const vec2 back = studio::motionAt(motion, vec2(x, y) / window);
            if (back == vec2(0.0f)) continue;
            arrows.push_back({vec2(x, y) + back * scale, vec2(x, y)});
        }
    }
    return arrows;
}

std::array<vec2, 3> arrowHead(const Arrow& arrow) {
    const vec2 along = arrow.to - arrow.from;
    const float length = glm::length(along);
    if (length == 0.0f) return {arrow.to, arrow.to, arrow.to};
    const float size = std::clamp(headShare * length, shortestHead, longestHead);
    const vec2 back = arrow.to - size / length * along,
               aside = 0.5f * size / length * vec2(-along.y, along.x);
    return {arrow.to, back + aside, back - aside};
}

}  // namespace limpid::viewer
