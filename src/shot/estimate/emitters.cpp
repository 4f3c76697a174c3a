#include "shot/estimate/emitters.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "shot/frame/pixel_layers.h"

namespace limpid::shot {
namespace {

constexpr float tolerance = 0.01f;
constexpr int likeNeighbours = 3;  ///< of 8; at the corner of a square lamp there are as many
constexpr float aboveMedian = 4.0f;
constexpr float shareAtEdge = 0.25f;
constexpr int64_t filterWidth = 4;    ///< pixels; usual filters have a radius of 2 at most
constexpr float otherSurface = 0.1f;  ///< difference of a guide

class Picture {
  public:
    explicit Picture(const image::Image& image) : image_(image) {}

    /// Infinite lamps (too bright for a file in half precision) are alike, and above the median.
    vec3 at(size_t p) const {
        vec3 color(image_.pixels[3 * p], image_.pixels[3 * p + 1], image_.pixels[3 * p + 2]);
        for (int c = 0; c < 3; ++c)
            if (color[c] == INFINITY) color[c] = largestHalf;
        return color;
    }
    float luminance(size_t p) const { return shot::luminance(at(p)); }
    bool isInfinite(size_t p) const {
        const float* const color = &image_.pixels[3 * p];
        return std::find(color, color + 3, INFINITY) != color + 3;
    }
    int64_t width() const { return image_.width; }

    /// Of the pixels that get light.
    float median() const {
        std::vector<float> values;
        for (size_t p = 0; p < size(); ++p)
            if (luminance(p) > 0.0f && std::isfinite(luminance(p))) values.push_back(luminance(p));
        if (values.empty()) return 0.0f;
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        std::nth_element(values.begin(), middle, values.end());
        return *middle;
    }
    size_t size() const { return image_.pixels.size() / 3; }

    /// Calls use(q) for the pixels around p.
    template <typename Use>
    void forNeighbours(size_t p, const Use& use) const {
        const auto x = static_cast<int64_t>(p % image_.width), y = static_cast<int64_t>(p / image_.width);
        for (int64_t v = std::max<int64_t>(y - 1, 0); v <= std::min<int64_t>(y + 1, image_.height - 1); ++v)
            for (int64_t u = std::max<int64_t>(x - 1, 0); u <= std::min<int64_t>(x + 1, image_.width - 1);
                 ++u)
                if (u != x || v != y) use(static_cast<size_t>(v * image_.width + u));
    }

  private:
    const image::Image& image_;
};

bool isLike(const vec3& a, const vec3& b) {
    const vec3 limit = tolerance * glm::max(a, b);
    return glm::all(glm::lessThanEqual(glm::abs(a - b), limit));
}

bool isAlikeIn(const image::Image* guide, size_t p, size_t q) {
    for (size_t c = 0; guide && c < guide->components; ++c) {
        const float* const values = &guide->pixels[c];
        if (std::abs(values[guide->components * p] - values[guide->components * q]) > otherSurface)
            return false;
    }
    return true;
}

class Surfaces {
  public:
    explicit Surfaces(const SurfaceGuides& guides) : guides_(guides), hasIds_(hasIds(guides.id)) {}

    /// `around`: the pixels around the spot.
    bool isOwn(const std::vector<size_t>& spot, const std::vector<size_t>& around) const {
        if (!hasIds_ && !isMostlyOne(around)) return false;
        return std::any_of(spot.begin(), spot.end(), [&](size_t p) { return countLike(p, around) == 0; });
    }

  private:
    static bool hasIds(const image::Image* id) {
        return id && std::adjacent_find(id->pixels.begin(), id->pixels.end(), std::not_equal_to<>()) !=
                         id->pixels.end();
    }
    bool isSame(size_t p, size_t q) const {
        if (hasIds_) return isAlikeIn(guides_.id, p, q);
        return isAlikeIn(guides_.albedo, p, q) && isAlikeIn(guides_.normal, p, q);
    }
    std::ptrdiff_t countLike(size_t p, const std::vector<size_t>& pixels) const {
        return std::count_if(pixels.begin(), pixels.end(), [&](size_t q) { return isSame(p, q); });
    }
    bool isMostlyOne(const std::vector<size_t>& pixels) const {
        const auto half = static_cast<std::ptrdiff_t>((pixels.size() + 1) / 2);
        return std::any_of(pixels.begin(), pixels.end(),
                           [&](size_t p) { return countLike(p, pixels) >= half; });
    }

    SurfaceGuides guides_;
    bool hasIds_;
};

/// The bright pixels that are connected with `first`. Empty if they are more than a filter makes of one
/// sample.
std::vector<size_t> smallSpot(const Picture& picture, const std::vector<uint8_t>& bright, size_t first) {
    std::vector<size_t> spot{first};
    int64_t left = INT64_MAX, right = 0, top = INT64_MAX, bottom = 0;
    for (size_t i = 0; i < spot.size(); ++i) {  // it grows
        const size_t p = spot[i];
        const auto x = static_cast<int64_t>(p) % picture.width(),
                   y = static_cast<int64_t>(p) / picture.width();
        left = std::min(left, x);
        right = std::max(right, x);
        top = std::min(top, y);
        bottom = std::max(bottom, y);
        if (right - left >= filterWidth || bottom - top >= filterWidth) return {};
        picture.forNeighbours(p, [&](size_t q) {
            if (bright[q] && std::find(spot.begin(), spot.end(), q) == spot.end()) spot.push_back(q);
        });
    }
    return spot;
}

std::vector<size_t> pixelsAround(const Picture& picture, const std::vector<size_t>& spot) {
    std::vector<size_t> around;
    const auto isIn = [](const std::vector<size_t>& pixels, size_t q) {
        return std::find(pixels.begin(), pixels.end(), q) != pixels.end();
    };
    for (const size_t p : spot)
        picture.forNeighbours(p, [&](size_t q) {
            if (!isIn(spot, q) && !isIn(around, q)) around.push_back(q);
        });
    return around;
}

/// Takes infinite spots out of `inside` that may come from one sample.
void dropFireflies(const Picture& picture, const std::vector<float>& distance, const SurfaceGuides& guides,
                   std::vector<uint8_t>& inside) {
    const Surfaces surfaces(guides);
    std::vector<uint8_t> bright = inside;
    forEachPixel(bright.size(), [&](size_t p) {
        if (distance[p] > 0.0f && picture.isInfinite(p)) bright[p] = 1;
    });
    for (size_t p = 0; p < bright.size(); ++p) {
        if (!bright[p]) continue;
        bool isFirst = true;  // each spot is looked at from its first pixel
        picture.forNeighbours(p, [&](size_t q) { isFirst = isFirst && (q > p || !bright[q]); });
        if (!isFirst) continue;
        const std::vector<size_t> spot = smallSpot(picture, bright, p);
        const bool isInfinite =
            std::any_of(spot.begin(), spot.end(), [&](size_t q) { return picture.isInfinite(q); });
        if (!isInfinite || surfaces.isOwn(spot, pixelsAround(picture, spot))) continue;
        for (const size_t q : spot) inside[q] = 0;
    }
}

}  // namespace

std::vector<uint8_t> findEmitters(const image::Image& beauty, const std::vector<float>& distance,
                                  const SurfaceGuides& guides) {
    const Picture picture(beauty);
    const float least = aboveMedian * picture.median();
    std::vector<uint8_t> inside(picture.size()), all;
    forEachPixel(inside.size(), [&](size_t p) {
        if (!(distance[p] > 0.0f)) return;
        if (!(picture.luminance(p) > least && std::isfinite(picture.luminance(p)))) return;
        int alike = 0;
        picture.forNeighbours(p, [&](size_t q) { alike += isLike(picture.at(p), picture.at(q)); });
        inside[p] = alike >= likeNeighbours;
    });
    dropFireflies(picture, distance, guides, inside);
    all = inside;
    forEachPixel(inside.size(), [&](size_t p) {
        if (inside[p] || !std::isfinite(picture.luminance(p))) return;
        picture.forNeighbours(p, [&](size_t q) {
            if (inside[q] && picture.luminance(p) > shareAtEdge * picture.luminance(q)) all[p] = 1;
        });
    });
    return all;
}

}  // namespace limpid::shot
