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
/// Frames that differ by less, in the mean of the pixels, are still.
constexpr double stillDifference = 0.05;
/// Something moves if motion explains this share of the difference (large motion, perhaps of a small object),
/// or if half of the pixels move by more than the error of the search (slow motion, which hardly differs).
constexpr double explainedShare = 0.3;
constexpr float slowMotion = 0.25f;
constexpr const char* zeroMotionProblem =
    "the motion vectors are all 0 although the picture changes, so motion is searched (Blender writes no "
    "vectors with motion blur)";

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

int rounded(float value) {
    return static_cast<int>(std::lround(value));
}

/// To the most similar of 3x3 pixels: at edges, pixels are noisy means of several surfaces.
int nearestDifference(const GuideLevel& here, const GuideLevel& there, int x, int y, const vec2& motion) {
    const int u = x + rounded(motion.x), v = y + rounded(motion.y);
    int smallest = std::numeric_limits<int>::max();
    for (int j = v - 1; j <= v + 1; ++j)
        for (int i = u - 1; i <= u + 1; ++i)
            smallest = std::min(smallest, differenceOf(here.at(x, y), there.clamped(i, j)));
    return smallest;
}

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

    int differenceAt(int x, int y, const vec2& motion) const {
        return nearestDifference(here_, there_, x, y, motion);
    }

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
    const int u = x + rounded(motion.x), v = y + rounded(motion.y);
    if (u < 0 || v < 0 || u >= level.width || v >= level.height) return std::nullopt;
    if (there.differenceAt(x, y, motion) > otherSurface) return std::nullopt;
    const float limit = returnTolerance + returnShare * glm::length(motion);
    if (glm::length(motion + back.at(u, v)) > limit) return std::nullopt;
    return motion;
}

bool sameSize(const std::vector<GuideLevel>& a, const std::vector<GuideLevel>& b) {
    return !a.empty() && !b.empty() && a[0].width == b[0].width && a[0].height == b[0].height;
}

/// Calls use(x, y) for some 50,000 pixels; the distance is odd, so that columns do not repeat.
template <typename Use>
void forSomePixels(const GuideLevel& level, const Use& use) {
    const size_t stride = (level.texels.size() / 50000) | 1u, width = static_cast<size_t>(level.width);
    for (size_t p = 0; p < level.texels.size(); p += stride)
        use(static_cast<int>(p % width), static_cast<int>(p / width));
}

bool isStill(const GuideLevel& now, const GuideLevel& before) {
    double sum = 0.0, count = 0.0;
    forSomePixels(now, [&](int x, int y) {
        sum += differenceOf(now.at(x, y), before.at(x, y));
        count += 1.0;
    });
    return sum < stillDifference * count;
}

/// True if this motion rather than noise makes the frames differ. Uncertain motion explains nothing.
bool explains(const image::Image& motion, const GuideLevel& now, const GuideLevel& before) {
    double still = 0.0, left = 0.0, moving = 0.0, count = 0.0;
    forSomePixels(now, [&](int x, int y) {
        const auto column = static_cast<uint32_t>(x), row = static_cast<uint32_t>(y);
        const vec2 moved(motion.at(column, row, 0), motion.at(column, row, 1));
        const bool certain = moved.x < MotionSearch::uncertain;
        const int unmoved = nearestDifference(now, before, x, y, vec2(0.0f));
        still += unmoved;
        left += certain ? nearestDifference(now, before, x, y, moved) : unmoved;
        moving += certain && glm::length(moved) > slowMotion ? 1.0 : 0.0;
        count += 1.0;
    });
    return still - left > explainedShare * still || moving > 0.5 * count;
}

/// From pixels to the file's units.
void encode(image::Image& motion, const Encoding& encoding) {
    vec2 scale = 1.0f / encoding.motionScale;
    if (encoding.motionUnit == MotionUnit::Picture) scale /= vec2(motion.width, motion.height);
    forEachPixel(motion.pixels.size(), [&](size_t i) {
        float& value = motion.pixels[i];
        value = value < MotionSearch::uncertain ? value * scale[static_cast<int>(i % 2)] : INFINITY;
    });
}

}  // namespace

std::optional<image::Image> MotionSearch::next(const ShotLayers& layers, bool continues) {
    const std::vector<GuideLevel> before = std::move(last_);
    last_ = guidePyramid(layers);
    if (!continues || !sameSize(before, last_)) return std::nullopt;
    return search(before);
}

void MotionSearch::replaceZero(ShotLayers& layers, const Encoding& encoding, bool continues) {
    const std::vector<GuideLevel> before = std::move(last_);
    last_ = guidePyramid(layers);
    const bool comparable = continues && sameSize(before, last_);
    if (comparable && (moves_ || !isStill(last_.front(), before.front()))) {
        image::Image motion = search(before);
        moves_ = moves_ || explains(motion, last_.front(), before.front());
        if (moves_) {
            encode(motion, encoding);
            layers.images["motion"] = std::move(motion);
        }
    }
    if (!moves_) return restoreZeroMotion(layers);
    layers.zeroMotion = false;
    layers.motionSearched = true;
    layers.problems.emplace_back(zeroMotionProblem);
}

image::Image MotionSearch::search(const std::vector<GuideLevel>& before) const {
    const MotionField toBefore = matchBlocks(last_, before), toNow = matchBlocks(before, last_);
    const PixelMotion there(last_.front(), before.front(), toBefore),
        back(before.front(), last_.front(), toNow);
    image::Image result(static_cast<uint32_t>(last_.front().width),
                        static_cast<uint32_t>(last_.front().height), 2);
    forEachPixel(result.pixels.size() / 2, [&](size_t p) {
        const auto x = static_cast<int>(p % result.width), y = static_cast<int>(p / result.width);
        const vec2 moved = certainMotion(there, back, last_.front(), x, y).value_or(vec2(uncertain));
        result.pixels[2 * p] = moved.x;
        result.pixels[2 * p + 1] = moved.y;
    });
    return result;
}

}  // namespace limpid::shot
