#include "shot/estimate/emitters.h"

#include <algorithm>
#include <cmath>

#include "shot/frame/pixel_layers.h"

namespace limpid::shot {
namespace {

constexpr float tolerance = 0.01f;
constexpr int likeNeighbours = 3;  ///< of 8; at the corner of a square lamp there are as many
constexpr float aboveMedian = 4.0f;
constexpr float shareAtEdge = 0.25f;

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

}  // namespace

std::vector<uint8_t> findEmitters(const image::Image& beauty, const std::vector<float>& distance) {
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
