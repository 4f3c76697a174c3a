#include "shot/recover/recovery.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "shot/frame/pixel_layers.h"
#include "shot/recover/box_means.h"

namespace limpid::shot {
namespace {

using denoise::HostFrame;
using image::Image;

// Chosen on the shots camera, objects and hair of scripts/shots, with 2, 8 and 64 samples.
/// Of this frame, in the running means of products.
constexpr float shareOfNow = 0.3f;
/// The share of a residual's energy that chance alone makes look like an error: more with few samples, whose
/// noise has rare bright pixels.
float shareOfChance(float samples) {
    return 0.1f + 0.8f / samples;
}
/// Means over neighbours are errors only beyond so many times the variance of noise.
float certaintyOfMeans(float samples) {
    return 8.0f * (1.0f + 4.0f / samples);
}
/// Edges' residuals are errors only beyond so many times the variance of noise.
constexpr float certaintyOfEdges = 2.0f;
/// Colours differ within a pixel at an edge by so many times the variance of those around it.
constexpr float variationInEdges = 1.0f;
/// Edges are believed where at least this share of the pixels around has none, and fully at a quarter more:
/// the noise around tells theirs.
constexpr float shareOfInner = 0.5f;
/// Residuals relative to the clean picture's luminance, plus this share of its mean. Single samples that are
/// much brighter must not rule the statistics.
constexpr float shareOfMean = 0.05f, largestResidual = 8.0f;
/// Of a pixel's error, in roots of the mean squared errors around.
constexpr float largestErrors = 2.0f;
constexpr uint32_t radiusOfProducts = 3, radiusOfMeans = 2, radiusOfNoise = 5;
/// Of the variance of white noise, what two box filters of 5 pixels leave: per axis (1/5^4) * 85.
constexpr float noiseInMeans = (85.0f / 625.0f) * (85.0f / 625.0f);

size_t neighbour(const Image& picture, size_t p, int dx, int dy) {
    const auto x = static_cast<int>(p % picture.width) + dx, y = static_cast<int>(p / picture.width) + dy;
    return static_cast<size_t>(std::clamp(y, 0, static_cast<int>(picture.height) - 1)) * picture.width +
           static_cast<size_t>(std::clamp(x, 0, static_cast<int>(picture.width) - 1));
}

vec3 colorAt(const Image& picture, size_t p) {
    return {picture.pixels[3 * p], picture.pixels[3 * p + 1], picture.pixels[3 * p + 2]};
}

void setColor(Image& picture, size_t p, const vec3& c) {
    picture.pixels[3 * p] = c.x;
    picture.pixels[3 * p + 1] = c.y;
    picture.pixels[3 * p + 2] = c.z;
}

/// 1 / (luminance + a share of its mean), per pixel.
Image scalesOf(const std::vector<float>& clean, const Image& noisy) {
    Image scales(noisy.width, noisy.height, 1);
    forEachPixel(scales.pixels.size(), [&](size_t p) {
        const float l = luminance({clean[4 * p], clean[4 * p + 1], clean[4 * p + 2]});
        scales.pixels[p] = std::isfinite(l) ? std::max(l, 0.0f) : 0.0f;
    });
    const double sum = std::accumulate(scales.pixels.begin(), scales.pixels.end(), 0.0);
    const float floor =
        std::max(static_cast<float>(shareOfMean * sum / static_cast<double>(scales.pixels.size())), 1e-20f);
    forEachPixel(scales.pixels.size(),
                 [&](size_t p) { scales.pixels[p] = 1.0f / (scales.pixels[p] + floor); });
    return scales;
}

Image residualOf(const std::vector<float>& clean, const Image& noisy, const Image& scales) {
    Image residual(noisy.width, noisy.height, 3);
    forEachPixel(residual.pixels.size(), [&](size_t i) {
        const float difference = (noisy.pixels[i] - clean[i / 3 * 4 + i % 3]) * scales.pixels[i / 3];
        residual.pixels[i] =
            std::isfinite(difference) ? std::clamp(difference, -largestResidual, largestResidual) : 0.0f;
    });
    return residual;
}

/// Where the pixel's surface was in the frame of the last call; none if it was not seen.
std::optional<vec2> positionBefore(const HostFrame& frame, size_t p) {
    const float share = frame.motion[4 * p + 3];
    if (!(share > 0.0f)) return std::nullopt;
    const vec2 at(static_cast<float>(p % frame.width) + frame.motion[4 * p] / share,
                  static_cast<float>(p / frame.width) + frame.motion[4 * p + 1] / share);
    const bool inside = at.x >= 0.0f && at.y >= 0.0f && at.x <= static_cast<float>(frame.width - 1) &&
                        at.y <= static_cast<float>(frame.height - 1);
    return inside ? std::optional(at) : std::nullopt;
}

vec3 bilinear(const Image& picture, const vec2& at) {
    const auto x = static_cast<size_t>(at.x), y = static_cast<size_t>(at.y);
    const float fx = at.x - static_cast<float>(x), fy = at.y - static_cast<float>(y);
    const size_t p = y * picture.width + x;
    const vec3 above = glm::mix(colorAt(picture, p), colorAt(picture, neighbour(picture, p, 1, 0)), fx);
    const vec3 below = glm::mix(colorAt(picture, neighbour(picture, p, 0, 1)),
                                colorAt(picture, neighbour(picture, p, 1, 1)), fx);
    return glm::mix(above, below, fy);
}

/// The mean of the products with the four neighbours.
float productWithNeighbours(const Image& residual, size_t p) {
    const vec3 sum =
        colorAt(residual, neighbour(residual, p, 1, 0)) + colorAt(residual, neighbour(residual, p, -1, 0)) +
        colorAt(residual, neighbour(residual, p, 0, 1)) + colorAt(residual, neighbour(residual, p, 0, -1));
    return 0.25f * glm::dot(colorAt(residual, p), sum);
}

/// Pixels at the edge of a surface or at its bend count 0, others 1.
Image innerPixels(const HostFrame& frame) {
    constexpr float bend = 0.02f, cosine = 0.9f;
    Image inner(frame.width, frame.height, 1, 1.0f);
    constexpr float farAway = 1e4f;  // where nothing is seen
    const auto distance = [&](size_t p) {
        const float z = distanceOf(frame, p);
        return z > 0.0f ? z : farAway;
    };
    const auto normal = [&](size_t p) {
        return vec3(frame.normal[4 * p], frame.normal[4 * p + 1], frame.normal[4 * p + 2]);
    };
    forEachPixel(inner.pixels.size(), [&](size_t p) {
        bool edge = false;
        for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(0, 1), std::pair(1, 1), std::pair(1, -1)}) {
            const size_t a = neighbour(inner, p, dx, dy), b = neighbour(inner, p, -dx, -dy);
            const float z = distance(p);
            edge = edge || std::abs(distance(a) + distance(b) - 2.0f * z) > bend * z;
            for (const size_t q : {a, b}) {
                const vec3 n = normal(p), m = normal(q);
                edge = edge || glm::dot(n, m) < cosine * std::sqrt(glm::dot(n, n) * glm::dot(m, m));
            }
        }
        inner.pixels[p] = edge ? 0.0f : 1.0f;
    });
    return inner;
}

/// boxMeans() of the pixels whose weight is 1; 0 where there are none.
Image meansAmong(Image values, const Image& weights, uint32_t radius, int times = 1) {
    forEachPixel(values.pixels.size(),
                 [&](size_t i) { values.pixels[i] *= weights.pixels[i / values.components]; });
    Image shares = weights;
    for (int i = 0; i < times; ++i) {
        values = boxMeans(values, radius);
        shares = boxMeans(shares, radius);
    }
    forEachPixel(values.pixels.size(), [&](size_t i) {
        const float share = shares.pixels[i / values.components];
        values.pixels[i] = share > 1e-3f ? values.pixels[i] / share : 0.0f;
    });
    return values;
}

/// Of a pixel's `products`, the energy of errors: the larger of what the frame before and the neighbours say.
float errorOf(const Image& products, size_t p) {
    return std::max({products.pixels[3 * p], products.pixels[3 * p + 1], 0.0f});
}

/// The variance of the noise (of the sum of the components) among the inner pixels around each.
Image noiseOf(const Image& products, const Image& inner) {
    Image noise(products.width, products.height, 1);
    forEachPixel(noise.pixels.size(), [&](size_t p) {
        noise.pixels[p] = std::max(products.pixels[3 * p + 2] - errorOf(products, p), 0.0f);
    });
    return meansAmong(std::move(noise), inner, radiusOfNoise);
}

/// The variance of the clean picture over the 3x3 pixels around, relative, summed over the components.
float variationAt(const std::vector<float>& clean, const Image& scales, size_t p) {
    vec3 sum(0.0f), squares(0.0f);
    for (int i = 0; i < 9; ++i) {
        const size_t q = neighbour(scales, p, i % 3 - 1, i / 3 - 1);
        const vec3 value = vec3(clean[4 * q], clean[4 * q + 1], clean[4 * q + 2]) * scales.pixels[p];
        sum += value;
        squares += value * value;
    }
    const vec3 variance = glm::max(squares / 9.0f - sum * sum / 81.0f, vec3(0.0f));
    return variance.x + variance.y + variance.z;
}

/// An edge mixes the colours around it, so what is beyond them is noise.
vec3 amongNeighbours(const std::vector<float>& clean, const Image& scales, size_t p, const vec3& color) {
    vec3 least(INFINITY), most(-INFINITY);
    for (int i = 0; i < 9; ++i) {
        const size_t q = neighbour(scales, p, i % 3 - 1, i / 3 - 1);
        const vec3 value(clean[4 * q], clean[4 * q + 1], clean[4 * q + 2]);
        least = glm::min(least, value);
        most = glm::max(most, value);
    }
    return glm::clamp(color, least, most);
}

/// One frame's statistics, from which the shares follow that are given back.
struct Statistics {
    const Image& products;  ///< Past::products
    Image inner;            ///< innerPixels()
    Image noise;            ///< noiseOf()
    float samples;
};

/// The share of each edge pixel's residual that is error: what is beyond the noise around, and beyond the
/// noise of what mixes within the pixel, which is as much as it varies, over the samples. Other pixels: 0.
Image edgeShares(const Statistics& s, const std::vector<float>& clean, const Image& scales) {
    Image shares = s.inner, energy = s.inner;
    forEachPixel(shares.pixels.size(), [&](size_t p) {
        shares.pixels[p] = 1.0f - s.inner.pixels[p];
        energy.pixels[p] = s.products.pixels[3 * p + 2];
    });
    energy = meansAmong(std::move(energy), shares, 1);
    const Image innerAround = boxMeans(s.inner, radiusOfNoise);
    forEachPixel(shares.pixels.size(), [&](size_t p) {
        if (shares.pixels[p] == 0.0f) return;
        const float noise = s.noise.pixels[p] + variationInEdges * variationAt(clean, scales, p) / s.samples;
        const float sure = std::clamp(4.0f * (innerAround.pixels[p] - shareOfInner), 0.0f, 1.0f);
        shares.pixels[p] =
            sure * std::max(1.0f - certaintyOfEdges * noise / std::max(energy.pixels[p], 1e-12f), 0.0f);
    });
    return shares;
}

/// What of each pixel's own residual is error. A single bright sample is not: errors are limited to what is
/// usual around, or at edges to what the colours around can mix to.
Image fineErrors(const Statistics& s, const std::vector<float>& clean, const Image& scales, Image residual) {
    const Image around = boxMeans(s.products, radiusOfProducts), edges = edgeShares(s, clean, scales);
    forEachPixel(scales.pixels.size(), [&](size_t p) {
        const float errors = errorOf(around, p);
        const float share = std::clamp(
            errors / std::max(around.pixels[3 * p + 2], 1e-12f) - shareOfChance(s.samples), 0.0f, 1.0f);
        const vec3 whole = colorAt(residual, p);
        vec3 error = share * whole;
        error *= std::min(largestErrors * std::sqrt(errors) / std::max(glm::length(error), 1e-12f), 1.0f);
        if (edges.pixels[p] > share) {
            const vec3 own = vec3(clean[4 * p], clean[4 * p + 1], clean[4 * p + 2]);
            const vec3 mixed =
                amongNeighbours(clean, scales, p, own + edges.pixels[p] * whole / scales.pixels[p]);
            error = (mixed - own) * scales.pixels[p];
        }
        setColor(residual, p, error);
    });
    return residual;
}

/// What of the residual's means over the inner pixels around is error: noise has nearly averaged out there.
Image smoothErrors(const Statistics& s, const Image& residual) {
    Image means = meansAmong(residual, s.inner, radiusOfMeans, 2);
    Image energy = s.inner;
    forEachPixel(energy.pixels.size(),
                 [&](size_t p) { energy.pixels[p] = glm::dot(colorAt(means, p), colorAt(means, p)); });
    energy = meansAmong(std::move(energy), s.inner, radiusOfMeans);
    const Image innerAround = boxMeans(boxMeans(s.inner, radiusOfMeans), radiusOfMeans);
    forEachPixel(energy.pixels.size(), [&](size_t p) {
        const float noise = noiseInMeans * s.noise.pixels[p] / std::max(innerAround.pixels[p], 0.05f);
        const float share = 1.0f - certaintyOfMeans(s.samples) * noise / std::max(energy.pixels[p], 1e-12f);
        setColor(means, p, s.inner.pixels[p] * std::clamp(share, 0.0f, 1.0f) * colorAt(means, p));
    });
    return means;
}

}  // namespace

void Recovery::apply(std::vector<float>& clean, const Image& noisy, const HostFrame& frame, uint32_t samples,
                     bool continues) {
    const bool follows =
        continues && past_ && past_->residual.width == noisy.width && past_->residual.height == noisy.height;
    const Image scales = scalesOf(clean, noisy);
    Past now{residualOf(clean, noisy, scales), Image(noisy.width, noisy.height, 3)};
    forEachPixel(scales.pixels.size(), [&](size_t p) {
        const vec3 own = colorAt(now.residual, p);
        const float beside = productWithNeighbours(now.residual, p);
        // Without a frame before, the neighbours speak for it, too.
        vec3 products(beside, beside, glm::dot(own, own));
        if (const auto before = follows ? positionBefore(frame, p) : std::nullopt) {
            products.x = glm::dot(own, bilinear(past_->residual, *before));
            const size_t q =
                static_cast<size_t>(before->y + 0.5f) * noisy.width + static_cast<size_t>(before->x + 0.5f);
            products = glm::mix(colorAt(past_->products, q), products, shareOfNow);
        }
        setColor(now.products, p, products);
    });
    Statistics statistics{now.products, innerPixels(frame), {}, static_cast<float>(std::max(samples, 1u))};
    statistics.noise = noiseOf(statistics.products, statistics.inner);
    const Image smooth = smoothErrors(statistics, now.residual);
    Image rest = now.residual;
    forEachPixel(rest.pixels.size(), [&](size_t i) { rest.pixels[i] -= smooth.pixels[i]; });
    const Image fine = fineErrors(statistics, clean, scales, std::move(rest));
    forEachPixel(fine.pixels.size(), [&](size_t i) {
        float& value = clean[i / 3 * 4 + i % 3];
        value = std::max(value + (smooth.pixels[i] + fine.pixels[i]) / scales.pixels[i / 3], 0.0f);
    });
    past_ = std::move(now);
}

}  // namespace limpid::shot
