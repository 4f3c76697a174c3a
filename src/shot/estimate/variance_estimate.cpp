#include "shot/estimate/variance_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "shot/frame/pixel_layers.h"

namespace limpid::shot {
namespace {

using denoise::HostFrame;

constexpr int meanReach = 1, squareReach = 3;  ///< pixels on each side: 3x3 and 7x7
/// A pixel that is like none of its neighbours is compared with all.
constexpr float leastLikeness = 1e-4f;
/// What a neighbour counts if the pixel on the opposite side does not.
constexpr float oneSided = 0.03f;
/// A square counts as at most that many variances; chosen on rooms of `builtin:room-N`, with 2 and 8 samples.
constexpr float largestSquare = 9.0f;
/// From here on, a brighter pixel is a firefly: five standard errors.
constexpr float fireflySquare = 25.0f;
/// As for the network's kernels (docs/kpcn.md): added to albedo before light is divided by it.
constexpr float albedoEpsilon = 0.00316f;

float luminanceAt(const std::vector<float>& texels, size_t p) {
    const float value = 0.2126f * texels[4 * p] + 0.7152f * texels[4 * p + 1] + 0.0722f * texels[4 * p + 2];
    return std::isfinite(value) ? std::max(value, 0.0f) : 0.0f;
}

/// How far neighbours show the same surface: from 0 (outside the picture) to 1. The pixel itself hardly
/// counts, or the estimate for one that is like no other would be its own noise.
class Likeness {
  public:
    explicit Likeness(const HostFrame& frame)
        : frame_(frame),
          width_(static_cast<int>(frame.width)),
          height_(static_cast<int>(frame.height)),
          surfaces_(frame.pixelCount()) {
        forEachPixel(surfaces_.size(), [&](size_t p) {
            const vec3 n(frame.normal[4 * p], frame.normal[4 * p + 1], frame.normal[4 * p + 2]);
            const float length = glm::length(n), share = frame.depth[4 * p + 1];
            surfaces_[p].normal = length > 0.0f && std::isfinite(length) ? n / length : vec3(0.0f);
            surfaces_[p].distance = share > 0.0f ? frame.depth[4 * p] / share : 0.0f;
        });
        forEachPixel(surfaces_.size(),
                     [&](size_t p) { surfaces_[p].slope = vec2(slopeOf(p, 1, 0), slopeOf(p, 0, 1)); });
    }

    float at(size_t p, int dx, int dy) const {
        if (!isInside(p, dx, dy)) return 0.0f;
        const size_t q = neighbour(p, dx, dy);
        const Surface& here = surfaces_[p];
        const Surface& there = surfaces_[q];
        const bool same = frame_.ids.empty() || frame_.ids[2 * p] == frame_.ids[2 * q];
        if (p == q || !same || (here.distance > 0.0f) != (there.distance > 0.0f)) return leastLikeness;
        if (!(here.distance > 0.0f)) return 1.0f;
        const vec2 steps(std::abs(dx), std::abs(dy));
        const float apart =
            (there.distance - here.distance) / (0.01f * here.distance + glm::dot(here.slope, steps));
        const float turned = 1.0f - glm::dot(here.normal, there.normal);
        return std::max(std::exp(-16.0f * turned - apart * apart), leastLikeness);
    }

    size_t neighbour(size_t p, int dx, int dy) const {
        return static_cast<size_t>(static_cast<int64_t>(p) + dx + int64_t{dy} * width_);
    }

  private:
    struct Surface {
        vec3 normal{};
        float distance = 0.0f;  ///< 0: nothing is seen
        vec2 slope{};           ///< difference of distance from one pixel to the next
    };

    bool isInside(size_t p, int dx, int dy) const {
        const int x = static_cast<int>(p % frame_.width) + dx, y = static_cast<int>(p / frame_.width) + dy;
        return x >= 0 && y >= 0 && x < width_ && y < height_;
    }

    /// To the nearer of the two neighbours along an axis.
    float slopeOf(size_t p, int dx, int dy) const {
        float least = 0.5f * surfaces_[p].distance;
        for (const int side : {-1, 1})
            if (isInside(p, side * dx, side * dy))
                least = std::min(least, std::abs(surfaces_[neighbour(p, side * dx, side * dy)].distance -
                                                 surfaces_[p].distance));
        return least;
    }

    const HostFrame& frame_;
    int width_, height_;
    std::vector<Surface> surfaces_;
};

/// Diffuse and specular.
using Pair = vec2;

/// What the luminance of light is divided by.
Pair albedosAt(const HostFrame& frame, size_t p) {
    const float specular = frame.albedoSpecular.empty() ? 1.0f : luminanceAt(frame.albedoSpecular, p);
    return Pair(luminanceAt(frame.albedo, p), specular) + albedoEpsilon;
}

/// The squared difference from the mean of the neighbours, of light that varies by this alone; negative where
/// the pixel is darker.
Pair squareAt(size_t p, const std::vector<Pair>& light, const Likeness& likeness) {
    Pair sum(0.0f);
    float weights = 0.0f, squares = 0.0f;
    for (int dy = -meanReach; dy <= meanReach; ++dy)
        for (int dx = -meanReach; dx <= meanReach; ++dx) {
            const float one = likeness.at(p, dx, dy), other = likeness.at(p, -dx, -dy);
            if (!(one > 0.0f) || (dx == 0 && dy == 0)) continue;
            const float weight = one * (other + oneSided);
            sum += weight * light[likeness.neighbour(p, dx, dy)];
            weights += weight;
            squares += weight * weight;
        }
    if (!(weights > 0.0f)) return Pair(0.0f);  // a picture of one pixel
    const Pair away = light[p] - sum / weights;
    return away * glm::abs(away) / (1.0f + squares / (weights * weights));
}

/// The mean of the absolute values around, each at most `limit`.
Pair meanAround(size_t p, const std::vector<Pair>& values, const Pair& limit, const Likeness& likeness) {
    Pair sum(0.0f);
    float weights = 0.0f;
    for (int dy = -squareReach; dy <= squareReach; ++dy)
        for (int dx = -squareReach; dx <= squareReach; ++dx) {
            const float weight = likeness.at(p, dx, dy);
            if (!(weight > 0.0f)) continue;
            sum += weight * glm::min(glm::abs(values[likeness.neighbour(p, dx, dy)]), limit);
            weights += weight;
        }
    return sum / weights;
}

/// Fireflies would make all pixels around them look noisy. They themselves are: their square is
/// their variance, as their other samples count for little.
Pair varianceAt(size_t p, const std::vector<Pair>& squares, const Likeness& likeness) {
    Pair variance = meanAround(p, squares, Pair(INFINITY), likeness);
    for (int i = 0; i < 2; ++i) variance = meanAround(p, squares, largestSquare * variance, likeness);
    return glm::mix(variance, squares[p], glm::greaterThan(squares[p], fireflySquare * variance));
}

}  // namespace

void estimateVariances(HostFrame& frame, std::span<const LayerInfo* const> layers) {
    frame.samples = std::max(frame.samples, 2u);
    if (frame.specular.empty()) frame.specular.resize(4 * frame.pixelCount());
    const Likeness likeness(frame);
    const size_t count = frame.pixelCount();
    std::vector<Pair> light(count), squares(count), variances(count);
    forEachPixel(count, [&](size_t p) {
        light[p] = Pair(luminanceAt(frame.diffuse, p), luminanceAt(frame.specular, p)) / albedosAt(frame, p);
    });
    forEachPixel(count, [&](size_t p) { squares[p] = squareAt(p, light, likeness); });
    forEachPixel(count, [&](size_t p) {
        const Pair albedos = albedosAt(frame, p);
        variances[p] = varianceAt(p, squares, likeness) * albedos * albedos;
    });
    const auto ofDeviations = static_cast<float>(frame.samples - 1);
    for (const LayerInfo* layer : layers) {
        std::vector<float>& texels = frame[*layer];
        const bool diffuse = layer->member == "diffuse", specular = layer->member == "specular";
        forEachPixel(count, [&](size_t p) {
            texels[4 * p + 3] = diffuse    ? variances[p].x * ofDeviations
                                : specular ? variances[p].y * ofDeviations
                                           : 0.0f;
        });
    }
}

}  // namespace limpid::shot
