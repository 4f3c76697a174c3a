#include "viewer/compare/motion_arrows.h"

#include "studio/compare/motion_sample.h"

namespace limpid::viewer {
namespace {

constexpr float spacing = 32.0f;

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

}  // namespace limpid::viewer
