#include "image/metrics/flicker.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "base/error.h"
#include "base/math.h"
#include "image/io/row_sums.h"

namespace limpid::image {
namespace {

constexpr float depthTolerance = 0.1f;         // of the expected distance
constexpr float normalTolerance = 0.7071068f;  // cosine of 45 degrees
constexpr float minShare = 0.01f;              // exclude pixels whose remaining weight is smaller

size_t clampedIndex(int64_t x, int64_t y, uint32_t width, uint32_t height) {
    x = std::clamp<int64_t>(x, 0, int64_t{width} - 1);
    y = std::clamp<int64_t>(y, 0, int64_t{height} - 1);
    return static_cast<size_t>(y) * width + static_cast<size_t>(x);
}

/// Returns the indices of the pixels that a source's weights belong to, clamped to the border.
std::array<size_t, 4> pixelsOf(const Reprojection::Source& s, uint32_t width, uint32_t height) {
    const int64_t x = s.x, y = s.y;
    return {clampedIndex(x, y, width, height), clampedIndex(x + 1, y, width, height),
            clampedIndex(x, y + 1, width, height), clampedIndex(x + 1, y + 1, width, height)};
}

/// Returns the bilinear weights for a position in pixels (centres at + 0.5); all 0 outside the picture.
Reprojection::Source bilinear(double placeX, double placeY, uint32_t width, uint32_t height) {
    Reprojection::Source source;
    if (!(placeX >= 0.0 && placeX < width && placeY >= 0.0 && placeY < height)) return source;
    const double left = std::floor(placeX - 0.5), top = std::floor(placeY - 0.5);
    const double fx = placeX - 0.5 - left, fy = placeY - 0.5 - top;
    source.x = static_cast<int32_t>(left);
    source.y = static_cast<int32_t>(top);
    source.shares = {static_cast<float>((1 - fx) * (1 - fy)), static_cast<float>(fx * (1 - fy)),
                     static_cast<float>((1 - fx) * fy), static_cast<float>(fx * fy)};
    return source;
}

bool sameDepth(float expected, float found) {
    return std::abs(found - expected) <= depthTolerance * std::abs(expected);
}

bool sameNormal(vec3 a, vec3 b) {
    const float lengths = glm::length(a) * glm::length(b);
    // A normal of length 0 is a miss. Two misses are alike; a miss and a hit are not.
    if (lengths == 0.0f) return a == b;
    return glm::dot(a, b) >= normalTolerance * lengths;
}

/// Tests whether a pixel of the previous frame shows the same surface as a pixel of this frame.
class SurfaceTest {
  public:
    SurfaceTest(const Geometry& now, const Geometry& before)
        : now_(now),
          before_(before),
          depth_(now.depth && now.distanceChange && before.depth),
          normal_(now.normal && before.normal) {}

    bool same(size_t pixel, size_t previous) const {
        if (depth_ && !sameDepth(now_.depth->pixels[pixel] + now_.distanceChange->pixels[pixel],
                                 before_.depth->pixels[previous])) {
            return false;
        }
        return !normal_ || sameNormal(at(*now_.normal, pixel), at(*before_.normal, previous));
    }

  private:
    static vec3 at(const Image& image, size_t pixel) {
        const float* p = &image.pixels[3 * pixel];
        return {p[0], p[1], p[2]};
    }
    const Geometry& now_;
    const Geometry& before_;
    bool depth_, normal_;
};

/// Sets the weights of pixels that show another surface to 0, and scales the others to a sum of 1.
void keepSameSurface(Reprojection::Source& source, const std::array<size_t, 4>& previous, size_t pixel,
                     const SurfaceTest& test) {
    float sum = 0.0f;
    for (size_t k = 0; k < 4; ++k) {
        if (source.shares[k] > 0.0f && !test.same(pixel, previous[k])) source.shares[k] = 0.0f;
        sum += source.shares[k];
    }
    const float scale = sum >= minShare ? 1.0f / sum : 0.0f;
    for (float& share : source.shares) share *= scale;
}

bool excluded(const Reprojection::Source& source) {
    return source.shares == std::array<float, 4>{};
}

void checkSizes(const Geometry& now, const Geometry& before) {
    if (!now.motion) throw Error("a reprojection needs a motion layer");
    const Image& motion = *now.motion;
    if (motion.components != 2) throw Error("motion has two components");
    for (const auto* layer : {&now.distanceChange, &now.depth, &now.normal, &before.depth, &before.normal}) {
        if (*layer && ((*layer)->width != motion.width || (*layer)->height != motion.height))
            throw Error("layers of different sizes cannot be reprojected");
    }
}

Image difference(const Image& a, const Image& b) {
    if (a.pixels.size() != b.pixels.size()) throw Error("pictures of different sizes have no difference");
    Image result = a;
    for (size_t i = 0; i < a.pixels.size(); ++i) result.pixels[i] -= b.pixels[i];
    return result;
}

size_t countUsed(const Reprojection& r) {
    const auto used = [](const Reprojection::Source& source) { return !excluded(source); };
    return static_cast<size_t>(std::count_if(r.sources.begin(), r.sources.end(), used));
}

}  // namespace

Reprojection stillReprojection(uint32_t width, uint32_t height) {
    Reprojection result{width, height, {}, size_t{width} * height};
    result.sources.reserve(result.used);
    for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x)
            result.sources.push_back({static_cast<int32_t>(x), static_cast<int32_t>(y), {1, 0, 0, 0}});
    }
    return result;
}

Reprojection reproject(const Geometry& now, const Geometry& before) {
    checkSizes(now, before);
    const uint32_t width = now.motion->width, height = now.motion->height;
    Reprojection result{width, height, std::vector<Reprojection::Source>(size_t{width} * height), 0};
    const SurfaceTest test(now, before);
    tbb::parallel_for(uint32_t{0}, height, [&](uint32_t y) {
        for (uint32_t x = 0; x < width; ++x) {
            const size_t pixel = size_t{y} * width + x;
            const float* motion = &now.motion->pixels[2 * pixel];
            if (!validMotion(motion[0], motion[1])) continue;
            Reprojection::Source& source = result.sources[pixel];
            source = bilinear(x + 0.5 + static_cast<double>(motion[0]),
                              y + 0.5 + static_cast<double>(motion[1]), width, height);
            if (!excluded(source)) keepSameSurface(source, pixelsOf(source, width, height), pixel, test);
        }
    });
    result.used = countUsed(result);
    return result;
}

std::optional<double> temporalChange(const Image& now, const Image& before,
                                     const Reprojection& reprojection) {
    for (const Image* image : {&now, &before}) {
        if (image->components != 3 || image->width != reprojection.width ||
            image->height != reprojection.height)
            throw Error("temporal change is of pictures of 3 components, as large as their reprojection");
    }
    if (reprojection.used == 0) return std::nullopt;
    const size_t width = reprojection.width;
    const double sum = sumRows(reprojection.height, [&](size_t y) {
        double rowSum = 0.0;
        for (size_t i = y * width; i < (y + 1) * width; ++i) {
            const Reprojection::Source& source = reprojection.sources[i];
            if (excluded(source)) continue;
            const std::array<size_t, 4> pixels = pixelsOf(source, reprojection.width, reprojection.height);
            for (size_t c = 0; c < 3; ++c) {
                float was = 0.0f;
                for (size_t k = 0; k < 4; ++k) was += source.shares[k] * before.pixels[3 * pixels[k] + c];
                rowSum += std::abs(static_cast<double>(now.pixels[3 * i + c]) - static_cast<double>(was));
            }
        }
        return rowSum;
    });
    return sum / (3.0 * static_cast<double>(reprojection.used));
}

std::optional<double> flicker(const Image& test, const Image& testBefore, const Image& reference,
                              const Image& referenceBefore, const Reprojection& reprojection) {
    const auto ofTest = temporalChange(test, testBefore, reprojection);
    const auto ofReference = temporalChange(reference, referenceBefore, reprojection);
    if (!ofTest || !ofReference) return std::nullopt;
    return *ofTest - *ofReference;
}

std::optional<double> temporalError(const Image& test, const Image& testBefore, const Image& reference,
                                    const Image& referenceBefore, const Reprojection& reprojection) {
    return temporalChange(difference(test, reference), difference(testBefore, referenceBefore), reprojection);
}

}  // namespace limpid::image
