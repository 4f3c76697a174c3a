// FLIP for images of low dynamic range. Equation numbers are those of the paper that image/metrics.h names;
// what the paper leaves open (repeated borders, filter radii, the colour matrix) is as in NVIDIA's reference
// program.
#include "image/flip.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/math.h"
#include "image/color.h"
#include "image/metrics.h"
#include "image/metrics_check.h"
#include "image/separable_filter.h"

namespace limpid::image {
namespace {

constexpr float colorExponent = 0.7f;    // qc
constexpr float featureExponent = 0.5f;  // qf
constexpr float colorKnee = 0.4f;        // pc: this part of the largest colour difference ...
constexpr float colorKneeValue = 0.95f;  // pt: ... maps to this error
constexpr double featureWidth = 0.082;   // w: width of a feature, degrees

/// Contrast sensitivity as a sum of two Gaussians of frequency, a * sqrt(pi/b) * exp(-pi^2 x^2 / b) in
/// degrees.
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr Sensitivity achromatic{1.0, 0.0047, 0.0, 1e-5};
constexpr Sensitivity redGreen{1.0, 0.0053, 0.0, 1e-5};
constexpr Sensitivity blueYellow{34.1, 0.04, 13.5, 0.025};
constexpr double widestB = 0.04;

// ---- colour spaces ----

vec3 linearToXyz(vec3 c) {
    return {(10135552.0f * c.r + 8788810.0f * c.g + 4435075.0f * c.b) / 24577794.0f,
            (2613072.0f * c.r + 8788810.0f * c.g + 887015.0f * c.b) / 12288897.0f,
            (1425312.0f * c.r + 8788810.0f * c.g + 70074185.0f * c.b) / 73733382.0f};
}

vec3 xyzToLinear(vec3 c) {
    return {3.241003275f * c.x - 1.537398934f * c.y - 0.498615861f * c.z,
            -0.969224334f * c.x + 1.875930071f * c.y + 0.041554224f * c.z,
            0.055639423f * c.x - 0.204011202f * c.y + 1.057148933f * c.z};
}

/// The white of both spaces below: that of linear RGB (1,1,1).
const vec3 white = linearToXyz(vec3(1.0f));

/// Linearised CIELAB, in which filtering is fair: Y, Cx, Cz.
vec3 linearToYcxcz(vec3 c) {
    const vec3 n = linearToXyz(c) / white;
    return {116.0f * n.y - 16.0f, 500.0f * (n.x - n.y), 200.0f * (n.y - n.z)};
}

vec3 ycxczToLinear(vec3 c) {
    const float y = (c.x + 16.0f) / 116.0f;
    return xyzToLinear(vec3(y + c.y / 500.0f, y, y - c.z / 200.0f) * white);
}

/// CIELAB whose chroma shrinks with lightness (Hunt effect).
vec3 linearToHuntLab(vec3 c) {
    const auto f = [](float t) {
        constexpr float delta = 6.0f / 29.0f;
        return t > delta * delta * delta ? std::cbrt(t) : t / (3.0f * delta * delta) + 4.0f / 29.0f;
    };
    const vec3 n = linearToXyz(c) / white;
    const float fx = f(n.x), fy = f(n.y), fz = f(n.z);
    const float lightness = 116.0f * fy - 16.0f;
    return {lightness, 0.01f * lightness * 500.0f * (fx - fy), 0.01f * lightness * 200.0f * (fy - fz)};
}

/// What the eye makes of a filtered colour: clamped to what a screen can show, then Hunt-adjusted.
vec3 perceived(vec3 ycxcz) {
    return linearToHuntLab(glm::clamp(ycxczToLinear(ycxcz), vec3(0.0f), vec3(1.0f)));
}

/// HyAB distance, raised to qc.
float colorDistance(vec3 a, vec3 b) {
    const vec3 d = a - b;
    return std::pow(std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z), colorExponent);
}

/// The largest distance of two colours: green to blue.
float largestColorDistance() {
    return colorDistance(perceived(linearToYcxcz(vec3(0, 1, 0))), perceived(linearToYcxcz(vec3(0, 0, 1))));
}

/// Spreads distances over [0,1], most of it to small ones.
float redistribute(float distance, float largest) {
    const float knee = colorKnee * largest;
    if (distance < knee) return colorKneeValue / knee * distance;
    return colorKneeValue + (distance - knee) / (largest - knee) * (1.0f - colorKneeValue);
}

// ---- the colour pipeline ----

using Planes = std::array<Image, 3>;

Image decode(const Image& encoded) {
    Image linear(encoded.width, encoded.height, encoded.components);
    const size_t rowValues = size_t{encoded.width} * encoded.components;
    tbb::parallel_for(size_t{0}, size_t{encoded.height}, [&](size_t y) {
        for (size_t i = y * rowValues; i < (y + 1) * rowValues; ++i)
            linear.pixels[i] = srgbDecode(encoded.pixels[i]);
    });
    return linear;
}

Planes toYcxcz(const Image& linear) {
    Planes planes;
    planes.fill(Image(linear.width, linear.height, 1));
    const size_t width = linear.width;
    tbb::parallel_for(size_t{0}, size_t{linear.height}, [&](size_t y) {
        for (size_t i = y * width; i < (y + 1) * width; ++i) {
            const float* p = &linear.pixels[3 * i];
            const vec3 c = linearToYcxcz(vec3(p[0], p[1], p[2]));
            for (int k = 0; k < 3; ++k) planes[static_cast<size_t>(k)].pixels[i] = c[k];
        }
    });
    return planes;
}

/// Filters with a normalised sum of two Gaussians; each of them is separable, their sum is not.
Image filterBySensitivity(const Image& plane, const Sensitivity& s, double pixelsPerDegree) {
    constexpr double pi2 = std::numbers::pi * std::numbers::pi;
    const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(widestB / (2.0 * pi2)) * pixelsPerDegree));
    const auto filtered = [&](double b) {
        const Kernel kernel = gaussianKernel(radius, std::sqrt(b / (2.0 * pi2)) * pixelsPerDegree);
        return filterSeparably(plane, kernel, kernel);
    };
    // The share of each Gaussian in the sum of all weights of the square window.
    const auto volume = [&](double a, double b) {
        double sum = 0.0;
        for (int x = -radius; x <= radius; ++x)
            sum += std::exp(-pi2 * x * x / (pixelsPerDegree * pixelsPerDegree * b));
        return a * std::sqrt(std::numbers::pi / b) * sum * sum;
    };
    Image first = filtered(s.b1);
    if (s.a2 == 0.0) return first;
    const Image second = filtered(s.b2);
    const double share = volume(s.a1, s.b1) / (volume(s.a1, s.b1) + volume(s.a2, s.b2));
    for (size_t i = 0; i < first.pixels.size(); ++i) {
        const double a = first.pixels[i], b = second.pixels[i];
        first.pixels[i] = static_cast<float>(b + share * (a - b));
    }
    return first;
}

Planes filterBySensitivity(const Planes& planes, double pixelsPerDegree) {
    return {filterBySensitivity(planes[0], achromatic, pixelsPerDegree),
            filterBySensitivity(planes[1], redGreen, pixelsPerDegree),
            filterBySensitivity(planes[2], blueYellow, pixelsPerDegree)};
}

// ---- the feature pipeline ----

/// Sizes of edges and points at every pixel.
struct Features {
    Image edges, points;
};

/// Scales the positive weights to the sum 1 and the negative ones to -1.
Kernel balanced(Kernel kernel) {
    double positive = 0.0, negative = 0.0;
    for (const double w : kernel) (w > 0.0 ? positive : negative) += w;
    for (double& w : kernel) w /= w > 0.0 ? positive : -negative;
    return kernel;
}

Image length(const Image& x, const Image& y) {
    Image result(x.width, x.height, 1);
    for (size_t i = 0; i < result.pixels.size(); ++i) {
        result.pixels[i] = std::sqrt(x.pixels[i] * x.pixels[i] + y.pixels[i] * y.pixels[i]);
    }
    return result;
}

/// `luminancePlane`: Y of YCxCz. First and second derivatives of a Gaussian, along x and along y.
Features detectFeatures(const Image& luminancePlane, double pixelsPerDegree) {
    const double sigma = 0.5 * featureWidth * pixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3.0 * sigma));
    const Kernel smooth = gaussianKernel(radius, sigma);
    Kernel edge, point;
    for (int x = -radius; x <= radius; ++x) {
        const double weight = std::exp(-x * x / (2.0 * sigma * sigma));
        edge.push_back(-x * weight);
        point.push_back((x * x / (sigma * sigma) - 1.0) * weight);
    }
    edge = balanced(std::move(edge));
    point = balanced(std::move(point));

    Image normalised = luminancePlane;
    for (float& v : normalised.pixels) v = (v + 16.0f) / 116.0f;
    const Image smoothed = filterRows(normalised, smooth);
    return {length(filterColumns(filterRows(normalised, edge), smooth), filterColumns(smoothed, edge)),
            length(filterColumns(filterRows(normalised, point), smooth), filterColumns(smoothed, point))};
}

}  // namespace

Image flip(const Image& test, const Image& reference, double pixelsPerDegree) {
    checkComparable(test, reference);
    return flipOfLinear(decode(test), decode(reference), pixelsPerDegree);
}

Image flipOfLinear(const Image& test, const Image& reference, double pixelsPerDegree) {
    checkComparable(test, reference);
    const Planes testPlanes = toYcxcz(test), referencePlanes = toYcxcz(reference);
    const Features testFeatures = detectFeatures(testPlanes[0], pixelsPerDegree);
    const Features referenceFeatures = detectFeatures(referencePlanes[0], pixelsPerDegree);
    const Planes a = filterBySensitivity(testPlanes, pixelsPerDegree);
    const Planes b = filterBySensitivity(referencePlanes, pixelsPerDegree);

    Image map(test.width, test.height, 1);
    const float largest = largestColorDistance();
    const size_t width = test.width;
    tbb::parallel_for(size_t{0}, size_t{test.height}, [&](size_t y) {
        for (size_t i = y * width; i < (y + 1) * width; ++i) {
            const vec3 colorA(a[0].pixels[i], a[1].pixels[i], a[2].pixels[i]);
            const vec3 colorB(b[0].pixels[i], b[1].pixels[i], b[2].pixels[i]);
            const float colorError =
                redistribute(colorDistance(perceived(colorA), perceived(colorB)), largest);
            const float edges = std::abs(testFeatures.edges.pixels[i] - referenceFeatures.edges.pixels[i]);
            const float points = std::abs(testFeatures.points.pixels[i] - referenceFeatures.points.pixels[i]);
            const float featureError =
                std::pow(std::max(edges, points) / std::numbers::sqrt2_v<float>, featureExponent);
            // A difference of features amplifies a difference of colours.
            map.pixels[i] = std::clamp(std::pow(colorError, 1.0f - featureError), 0.0f, 1.0f);
        }
    });
    return map;
}

}  // namespace limpid::image
