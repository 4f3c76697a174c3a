#include "shot/motion/motion_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "shot/frame/pixel_layers.h"
#include "shot/motion/block_matching.h"

namespace limpid::shot {
namespace {

/// Motion there and back may differ by this, in pixels, and by this share of its length.
constexpr float returnTolerance = 1.0f, returnShare = 0.05f;
/// Motion of blocks that differs by at most this, in pixels, is interpolated.
constexpr float sameMotion = 0.75f;
/// Pixels that differ by more show different surfaces: as much as a fifth of white from black in each colour.
constexpr int otherSurface = 64;

/// The four blocks around a pixel, and where it lies between them.
struct Around {
    int column, row;
    float fx, fy;

    Around(const MotionField& field, const vec2& pixel) {
        // The centre of block (0, 0) is at the corner of the pixels 1 and 2.
        const vec2 at = (pixel + 0.5f) / static_cast<float>(blockDistance) - 0.5f;
        const vec2 limit(field.columns, field.rows);
        const vec2 inside = glm::clamp(at, vec2(-1.0f), limit);
        column = static_cast<int>(std::floor(inside.x));
        row = static_cast<int>(std::floor(inside.y));
        fx = inside.x - std::floor(inside.x);
        fy = inside.y - std::floor(inside.y);
    }
    std::array<vec2, 4> motion(const MotionField& field) const {
        return {field.at(column, row), field.at(column + 1, row), field.at(column, row + 1),
                field.at(column + 1, row + 1)};
    }
};

/// The motion of single pixels, from that of blocks.
class PixelMotion {
  public:
    PixelMotion(const GuideLevel& here, const GuideLevel& there, const MotionField& field)
        : here_(here), there_(there), field_(field) {}

    /// Where blocks move alike, what lies between them; at the edges of objects, what fits best.
    vec2 at(int x, int y) const {
        const Around around(field_, vec2(x, y));
        const std::array<vec2, 4> four = around.motion(field_);
        vec2 low = four[0], high = four[0];
        for (const vec2& motion : four) {
            low = glm::min(low, motion);
            high = glm::max(high, motion);
        }
        if (high.x - low.x <= sameMotion && high.y - low.y <= sameMotion)
            return glm::mix(glm::mix(four[0], four[1], around.fx), glm::mix(four[2], four[3], around.fx),
                            around.fy);
        vec2 best = four[0];
        int smallest = std::numeric_limits<int>::max();
        for (const vec2& motion : four) {
            const int difference = nearby(x, y, motion);
            if (difference >= smallest) continue;
            smallest = difference;
            best = motion;
        }
        return best;
    }

    /// To the most similar of 3x3 pixels: at edges, pixels are noisy means of several surfaces.
    int differenceAt(int x, int y, const vec2& motion) const {
        const int u = x + rounded(motion.x), v = y + rounded(motion.y);
        int smallest = std::numeric_limits<int>::max();
        for (int j = v - 1; j <= v + 1; ++j)
            for (int i = u - 1; i <= u + 1; ++i)
                smallest = std::min(smallest, differenceOf(here_.at(x, y), there_.clamped(i, j)));
        return smallest;
    }

    static int rounded(float value) { return static_cast<int>(std::lround(value)); }

  private:
    /// The difference of 3x3 pixels.
    int nearby(int x, int y, const vec2& motion) const {
        const int dx = rounded(motion.x), dy = rounded(motion.y);
        int sum = 0;
        for (int v = y - 1; v <= y + 1; ++v)
            for (int u = x - 1; u <= x + 1; ++u)
                sum += differenceOf(here_.clamped(u, v), there_.clamped(u + dx, v + dy));
        return sum;
    }

    const GuideLevel& here_;
    const GuideLevel& there_;
    const MotionField& field_;
};

/// None where motion leads out of the picture, to another surface, or does not lead back.
std::optional<vec2> certainMotion(const PixelMotion& there, const PixelMotion& back, const GuideLevel& level,
                                  int x, int y) {
    const vec2 motion = there.at(x, y);
    const int u = x + PixelMotion::rounded(motion.x), v = y + PixelMotion::rounded(motion.y);
    if (u < 0 || v < 0 || u >= level.width || v >= level.height) return std::nullopt;
    if (there.differenceAt(x, y, motion) > otherSurface) return std::nullopt;
    const float limit = returnTolerance + returnShare * glm::length(motion);
    if (glm::length(motion + back.at(u, v)) > limit) return std::nullopt;
    return motion;
}

bool sameSize(const std::vector<GuideLevel>& a, const std::vector<GuideLevel>& b) {
    return !a.empty() && !b.empty() && a[0].width == b[0].width && a[0].height == b[0].height;
}

}  // namespace

std::optional<image::Image> MotionSearch::next(const ShotLayers& layers, bool continues) {
    const std::vector<GuideLevel> before = std::move(last_);
    last_ = guidePyramid(layers);
    if (!continues || !sameSize(before, last_)) return std::nullopt;
    const MotionField toBefore = matchBlocks(last_, before), toNow = matchBlocks(before, last_);
    const PixelMotion there(last_.front(), before.front(), toBefore),
        back(before.front(), last_.front(), toNow);
    image::Image result(layers.width, layers.height, 2);
    forEachPixel(result.pixels.size() / 2, [&](size_t p) {
        const auto x = static_cast<int>(p % layers.width), y = static_cast<int>(p / layers.width);
        const vec2 moved = certainMotion(there, back, last_.front(), x, y).value_or(vec2(uncertain));
        result.pixels[2 * p] = moved.x;
        result.pixels[2 * p + 1] = moved.y;
    });
    return result;
}

}  // namespace limpid::shot
