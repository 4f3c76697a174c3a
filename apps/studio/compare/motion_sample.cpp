#include "studio/compare/motion_sample.h"

#include <cmath>

#include "studio/compare/pixel_at.h"

namespace limpid::studio {
namespace {

constexpr float leastMotion = 0.25f;  ///< pixels

}  // namespace

vec2 motionAt(const image::Image& motion, const vec2& position) {
    const uint32_t column = pixelAt(position.x, motion.width), row = pixelAt(position.y, motion.height);
    if (motion.components > 3 && motion.at(column, row, 3) <= 0.0f) return vec2(0.0f);
    const vec2 back(motion.at(column, row, 0), motion.at(column, row, 1));
    const bool moves = std::isfinite(back.x) && std::isfinite(back.y) && glm::length(back) >= leastMotion;
    return moves ? back : vec2(0.0f);
}

}  // namespace limpid::studio
