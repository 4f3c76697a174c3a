#include "shot/motion_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace limpid::shot {
namespace {

using image::Image;

/// What the frames are compared by: layers without noise.
struct Guide {
    const Image* now;
    const Image* before;
    float scale;  ///< of a difference
};

std::vector<Guide> guidesOf(const ShotLayers& before, const ShotLayers& now) {
    std::vector<Guide> guides;
    const auto add = [&](const char* role, float scale) {
        const Image* const a = now.find(role);
        const Image* const b = before.find(role);
        if (a && b) guides.push_back({a, b, scale});
    };
    add("albedo", 1.0f);
    add("normal", 0.5f);
    return guides;
}

/// Between 0 and 1.
float difference(const std::vector<Guide>& guides, size_t now, size_t before) {
    float sum = 0.0f;
    for (const Guide& guide : guides)
        for (size_t c = 0; c < 3; ++c) {
            const float d =
                guide.scale * std::abs(guide.now->pixels[3 * now + c] - guide.before->pixels[3 * before + c]);
            sum += std::isfinite(d) ? d : 0.0f;
        }
    return std::min(sum / 3.0f, 1.0f);
}

/// The pixel at p + moved; none outside the picture.
std::optional<size_t> pixelAt(const ShotLayers& layers, size_t p, const vec2& moved) {
    const auto x = static_cast<float>(p % layers.width) + moved.x + 0.5f;
    const auto y = static_cast<float>(p / layers.width) + moved.y + 0.5f;
    if (!(x >= 0.0f && y >= 0.0f && x < static_cast<float>(layers.width) &&
          y < static_cast<float>(layers.height)))
        return std::nullopt;
    return static_cast<size_t>(y) * layers.width + static_cast<size_t>(x);
}

/// To the most similar of the 3x3 pixels around `before`: at edges, pixels are noisy means of several
/// surfaces.
float nearestDifference(const std::vector<Guide>& guides, const ShotLayers& layers, size_t now,
                        size_t before) {
    float least = 1.0f;
    const auto x = static_cast<int64_t>(before % layers.width),
               y = static_cast<int64_t>(before / layers.width);
    for (int64_t v = std::max<int64_t>(y - 1, 0); v <= std::min<int64_t>(y + 1, layers.height - 1); ++v)
        for (int64_t u = std::max<int64_t>(x - 1, 0); u <= std::min<int64_t>(x + 1, layers.width - 1); ++u)
            least = std::min(least, difference(guides, now, static_cast<size_t>(v * layers.width + u)));
    return least;
}

struct Candidate {
    vec2 scale;
    MotionUnit unit;
};

std::optional<vec2> movedBy(const Image& motion, size_t p, const Candidate& by, float noMotion) {
    vec2 m(motion.pixels[motion.components * p], motion.pixels[motion.components * p + 1]);
    if (!(std::abs(m.x) < noMotion && std::abs(m.y) < noMotion)) return std::nullopt;
    m *= by.scale;
    return by.unit == MotionUnit::Picture ? m * vec2(motion.width, motion.height) : m;
}

/// Large pictures are compared at so many pixels' distance; odd, so that columns do not repeat.
size_t strideOf(const ShotLayers& layers) {
    return (size_t{layers.width} * layers.height / 50000) | 1u;
}

struct Sums {
    double still = 0.0, moved = 0.0;
    size_t pixels = 0, inside = 0, alike = 0;

    double explained() const { return still > 0.0 ? 1.0 - moved / still : 0.0; }
};

/// A pixel whose motion leaves the picture counts as unexplained, so that a motion that is too long is not
/// better.
Sums compare(const ShotLayers& before, const ShotLayers& now, const Candidate& by, float noMotion) {
    const Image& motion = *now.find("motion");
    const std::vector<Guide> guides = guidesOf(before, now);
    Sums sums;
    const size_t stride = strideOf(now);
    for (size_t p = 0; p < size_t{now.width} * now.height; p += stride) {
        const auto moved = movedBy(motion, p, by, noMotion);
        if (!moved) continue;
        const float still = nearestDifference(guides, now, p, p);
        const auto from = pixelAt(now, p, *moved);
        const float left = from ? nearestDifference(guides, now, p, *from) : still;
        sums.still += static_cast<double>(still);
        sums.moved += static_cast<double>(left);
        ++sums.pixels;
        sums.inside += from.has_value() ? 1 : 0;
        sums.alike += from && left < 0.1f ? 1 : 0;
    }
    return sums;
}

bool comparable(const ShotLayers& before, const ShotLayers& now) {
    return before.width == now.width && before.height == now.height && !guidesOf(before, now).empty();
}

/// Without motion: the share of pixels that look like one of the previous frame's nearby.
double shareFound(const ShotLayers& before, const ShotLayers& now) {
    const std::vector<Guide> guides = guidesOf(before, now);
    constexpr int reach = 5;
    size_t found = 0, all = 0;
    const uint32_t stride = std::max(3u, now.height / 60);
    for (uint32_t y = reach; y + reach < now.height; y += stride) {
        for (uint32_t x = reach; x + reach < now.width; x += stride) {
            const size_t p = size_t{y} * now.width + x;
            bool alike = false;
            for (int dy = -reach; dy <= reach && !alike; ++dy)
                for (int dx = -reach; dx <= reach && !alike; ++dx)
                    alike = difference(guides, p, *pixelAt(now, p, vec2(dx, dy))) < 0.1f;
            found += alike ? 1 : 0;
            ++all;
        }
    }
    return all > 0 ? static_cast<double>(found) / static_cast<double>(all) : 1.0;
}

}  // namespace

std::optional<MotionCheck> checkMotion(const ShotLayers& before, const ShotLayers& now,
                                       const Encoding& encoding) {
    if (!now.find("motion") || !comparable(before, now)) return std::nullopt;
    const vec2 own = encoding.motionScale;
    const Sums sums = compare(before, now, {own, encoding.motionUnit}, encoding.noMotion);
    if (sums.pixels == 0) return std::nullopt;
    MotionCheck check;
    check.change = sums.still / static_cast<double>(sums.pixels);
    const size_t looked = (size_t{now.width} * now.height + strideOf(now) - 1) / strideOf(now);
    check.share = static_cast<double>(sums.pixels) / static_cast<double>(looked);
    check.explained = sums.explained();
    check.betterExplained = check.explained + 0.2;
    const bool pixels = encoding.motionUnit == MotionUnit::Pixels;
    const MotionUnit other = pixels ? MotionUnit::Picture : MotionUnit::Pixels;
    for (const MotionUnit unit : {encoding.motionUnit, other}) {
        for (const vec2 sign : {vec2(1, 1), vec2(-1, -1), vec2(1, -1), vec2(-1, 1)}) {
            const Candidate candidate{own * sign, unit};
            const double explained = compare(before, now, candidate, encoding.noMotion).explained();
            if (explained <= check.betterExplained) continue;
            check.betterExplained = explained;
            check.better = fmt::format("motion.scale={},{}", candidate.scale.x, candidate.scale.y);
            if (unit != encoding.motionUnit)
                check.better += fmt::format(" --map motion.unit={}", pixels ? "picture" : "pixels");
        }
    }
    return check;
}

bool isCut(const ShotLayers& before, const ShotLayers& now, const Encoding& encoding) {
    if (before.width != now.width || before.height != now.height) return true;
    if (!comparable(before, now)) return false;
    if (!now.find("motion")) return shareFound(before, now) < 0.25;
    const Sums sums = compare(before, now, {encoding.motionScale, encoding.motionUnit}, encoding.noMotion);
    // Where a camera moves by more than its picture, there is nothing to compare.
    if (sums.pixels == 0 || sums.inside < sums.pixels / 10) return true;
    return static_cast<double>(sums.alike) < 0.25 * static_cast<double>(sums.inside);
}

}  // namespace limpid::shot
