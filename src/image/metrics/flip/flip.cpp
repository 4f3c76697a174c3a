// FLIP for images of low dynamic range. Equation numbers are those of the paper that image/metrics/metrics.h
// names; what the paper leaves open (repeated borders, filter radii, the colour matrix) is as in NVIDIA's
// reference program. Its loops are in flip_rows.h.
#include "image/metrics/flip/flip.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <utility>

#include "image/color.h"
#include "image/metrics/flip/flip_rows.h"
#include "image/metrics/metrics.h"
#include "image/metrics/metrics_check.h"

namespace limpid::image {
namespace {

constexpr double featureWidth = 0.082;  // w: width of a feature, degrees
constexpr double pi2 = std::numbers::pi * std::numbers::pi;

/// Contrast sensitivity as a sum of two Gaussians of frequency, a * sqrt(pi/b) * exp(-pi^2 x^2 / b) in
/// degrees.
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr Sensitivity achromatic{1.0, 0.0047, 0.0, 1e-5};
constexpr Sensitivity redGreen{1.0, 0.0053, 0.0, 1e-5};
constexpr Sensitivity blueYellow{34.1, 0.04, 13.5, 0.025};
constexpr double widestB = 0.04;

constexpr size_t tileWidth = 4 * flipGroup;
constexpr size_t tileHeight = 128;

Image decode(const Image& encoded) {
    Image linear(encoded.width, encoded.height, encoded.components);
    const size_t rowValues = size_t{encoded.width} * encoded.components;
    tbb::parallel_for(size_t{0}, size_t{encoded.height}, [&](size_t y) {
        for (size_t i = y * rowValues; i < (y + 1) * rowValues; ++i)
            linear.pixels[i] = srgbDecode(encoded.pixels[i]);
    });
    return linear;
}

/// Values of `function` at 1 .. radius, divided by `sum`. What a float cannot add to the middle is left out.
template <typename Function>
std::vector<float> weightsOf(int radius, double sum, const Function& function) {
    std::vector<float> weights;
    for (int x = 1; x <= radius; ++x) weights.push_back(static_cast<float>(function(x) / sum));
    while (!weights.empty() && std::abs(weights.back()) < 1e-8f) weights.pop_back();
    return weights;
}

std::vector<float> gaussianWeights(int radius, double sigma) {
    const auto gaussian = [&](int x) { return std::exp(-x * x / (2.0 * sigma * sigma)); };
    double sum = 1.0;
    for (int x = 1; x <= radius; ++x) sum += 2.0 * gaussian(x);
    return weightsOf(radius, sum, gaussian);
}

/// The share of the first Gaussian in the sum of all weights of the square window.
float firstShare(const Sensitivity& s, int radius, double pixelsPerDegree) {
    const auto volume = [&](double a, double b) {
        double sum = 0.0;
        for (int x = -radius; x <= radius; ++x)
            sum += std::exp(-pi2 * x * x / (pixelsPerDegree * pixelsPerDegree * b));
        return a * std::sqrt(std::numbers::pi / b) * sum * sum;
    };
    const double first = volume(s.a1, s.b1);
    return static_cast<float>(first / (first + volume(s.a2, s.b2)));
}

/// The distance of green to blue, as the loops compute it.
float largestColorDistance() {
    const std::array<float, 3> green{0, 1, 0}, blue{0, 0, 1};
    std::array<std::array<float, flipGroup>, 6> rows{};
    std::array<float, 3 * flipGroup> colors{};
    for (size_t picture = 0; picture < 2; ++picture) {
        for (size_t i = 0; i < colors.size(); ++i) colors[i] = (picture == 0 ? green : blue)[i % 3];
        flipRows().toYcxcz(colors.data(), flipGroup, rows[3 * picture].data(), rows[3 * picture + 1].data(),
                           rows[3 * picture + 2].data());
    }
    const FlipRow a{.y = rows[0].data(), .cx = rows[1].data(), .cz = rows[2].data()};
    const FlipRow b{.y = rows[3].data(), .cx = rows[4].data(), .cz = rows[5].data()};
    std::array<float, flipGroup> distance{};
    flipRows().distances(a, b, flipGroup, distance.data());
    return distance[0];
}

/// Beyond every filter's reach.
constexpr size_t radiusOf(double pixelsPerDegree) {
    return static_cast<size_t>(3.0 * std::max(0.0450160, 0.5 * featureWidth) * pixelsPerDegree) + 2;
}

}  // namespace

/// A tile of one picture, filtered along the rows, with as many rows above and below as filters of columns
/// reach. Both pictures' tiles stay in a core's own cache, and the rows that a filter of columns looks at in
/// the fastest one.
struct LinearFlip::Planes {
    explicit Planes(size_t margin)
        : rows(tileHeight + 2 * margin),
          values(std::make_unique_for_overwrite<float[]>(PlaneCount * rows * tileWidth)) {}
    float* row(int plane, size_t y) const {
        return &values[(static_cast<size_t>(plane) * rows + y) * tileWidth];
    }
    size_t rows;
    std::unique_ptr<float[]> values;
};

/// One row of a tile, filtered both ways.
struct LinearFlip::RowBuffers {
    RowBuffers() : values(8 * tileWidth) {
        const auto at = [&](size_t i) { return &values[i * tileWidth]; };
        row = {at(0), at(1), at(2), at(3), at(4), at(5), at(6)};
        second = at(7);
    }
    std::vector<float> values;
    FlipRow row{};
    float* second;
};

/// What one thread needs, for one tile after the other.
struct LinearFlip::Workspace {
    explicit Workspace(size_t margin)
        : testPlanes(margin),
          referencePlanes(margin),
          padded(3 * (tileWidth + 2 * margin)),
          errors(tileWidth) {}
    Planes testPlanes, referencePlanes;
    RowBuffers test, reference;
    std::vector<float> padded;  ///< Y, Cx and Cz of a row, and of `margin` pixels on either side of it
    std::vector<float> errors;
};

LinearFlip::LinearFlip(uint32_t width, uint32_t height, double pixelsPerDegree)
    : width_(width), height_(height), margin_(radiusOf(pixelsPerDegree)) {
    const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(widestB / (2.0 * pi2)) * pixelsPerDegree));
    const auto gaussian = [&](double b) {
        return zeroPadded(gaussianWeights(radius, std::sqrt(b / (2.0 * pi2)) * pixelsPerDegree));
    };
    luma_ = gaussian(achromatic.b1);
    redGreen_ = gaussian(redGreen.b1);
    blueYellow_ = gaussian(blueYellow.b1);
    blueYellowSecond_ = gaussian(blueYellow.b2);
    blueYellowShare_ = firstShare(blueYellow, radius, pixelsPerDegree);

    // First and second derivatives of a Gaussian; positive weights have the sum 1, negative ones -1.
    const double sigma = 0.5 * featureWidth * pixelsPerDegree;
    const int featureRadius = static_cast<int>(std::ceil(3.0 * sigma));
    const auto slope = [&](int x) { return x * std::exp(-x * x / (2.0 * sigma * sigma)); };
    const auto curve = [&](int x) {
        return (x * x / (sigma * sigma) - 1.0) * std::exp(-x * x / (2.0 * sigma * sigma));
    };
    double slopes = 0.0, positive = 0.0, negative = curve(0);
    for (int x = 1; x <= featureRadius; ++x) {
        slopes += slope(x);
        (curve(x) > 0.0 ? positive : negative) += 2.0 * curve(x);
    }
    smooth_ = zeroPadded(gaussianWeights(featureRadius, sigma));
    edge_ = zeroPadded(weightsOf(featureRadius, slopes, slope));
    point_ = zeroPadded(weightsOf(featureRadius, 1.0,
                                  [&](int x) { return curve(x) / (curve(x) > 0.0 ? positive : -negative); }));
    largest_ = largestColorDistance();
}

void LinearFlip::filterRow(const float* rgb, const Tile& tile, std::vector<float>& padded, Planes& planes,
                           size_t row) const {
    const FlipRows& loops = flipRows();
    const size_t count = flipPadded(tile.width), length = padded.size() / 3;
    // What is inside the picture, of the pixels from `margin_` before the tile to as many behind it.
    const size_t begin = tile.left - std::min(tile.left, margin_);
    const size_t end = std::min(tile.left + count + margin_, width_);
    const size_t first = begin + margin_ - tile.left, last = end + margin_ - tile.left;
    std::array<float*, 3> values{};
    for (size_t c = 0; c < 3; ++c) values[c] = &padded[c * length];
    loops.toYcxcz(rgb + 3 * begin, end - begin, values[0] + first, values[1] + first, values[2] + first);
    for (float*& v : values) {
        // The picture's first and last pixel are repeated beyond its ends.
        std::fill_n(v, first, v[first]);
        std::fill(v + last, v + count + 2 * margin_, v[last - 1]);
        v += margin_;
    }
    const auto even = [&](const Weights& weights, int plane, float middle = 1.0f) {
        return FlipEven{weights.values.data(), middle, planes.row(plane, row)};
    };
    const size_t features = std::max({smooth_.reach, edge_.reach, point_.reach, luma_.reach});
    loops.filter(values[0], 1,
                 {features,
                  3,
                  {even(smooth_, Smooth), even(point_, Point, 0.0f), even(luma_, Luma)},
                  {edge_.values.data(), planes.row(Edge, row)}},
                 count);
    loops.filter(values[1], 1, {redGreen_.reach, 1, {even(redGreen_, RedGreen)}, {}}, count);
    loops.filter(values[2], 1,
                 {std::max(blueYellow_.reach, blueYellowSecond_.reach),
                  2,
                  {even(blueYellow_, BlueYellow), even(blueYellowSecond_, BlueYellowSecond)},
                  {}},
                 count);
}

LinearFlip::Weights LinearFlip::zeroPadded(std::vector<float> values) const {
    const size_t reach = values.size();
    values.resize(margin_, 0.0f);
    return {std::move(values), reach};
}

void LinearFlip::filterRows(const Image& picture, const Tile& tile, std::vector<float>& padded,
                            Planes& planes) const {
    size_t filtered = height_;
    for (size_t row = 0; row < tile.height + 2 * margin_; ++row) {
        // The picture's first and last row are repeated beyond its ends.
        const size_t above = tile.top + row;
        const size_t y = std::min(above - std::min(above, margin_), height_ - 1);
        if (y == filtered) {
            for (int plane = 0; plane < PlaneCount; ++plane)
                std::copy_n(planes.row(plane, row - 1), tileWidth, planes.row(plane, row));
        } else {
            filterRow(&picture.pixels[3 * width_ * y], tile, padded, planes, row);
        }
        filtered = y;
    }
}

void LinearFlip::smoothColumn(const float* column, const Weights& weights, size_t count,
                              float* result) const {
    flipRows().filter(column, tileWidth, {weights.reach, 1, {{weights.values.data(), 1.0f, result}}, {}},
                      count);
}

void LinearFlip::filterColumns(const Planes& planes, size_t row, size_t count, RowBuffers& buffers) const {
    const FlipRow& out = buffers.row;
    smoothColumn(planes.row(Edge, row), smooth_, count, out.edgeX);
    smoothColumn(planes.row(Point, row), smooth_, count, out.pointX);
    flipRows().filter(planes.row(Smooth, row), tileWidth,
                      {std::max(edge_.reach, point_.reach),
                       1,
                       {{point_.values.data(), 0.0f, out.pointY}},
                       {edge_.values.data(), out.edgeY}},
                      count);
    smoothColumn(planes.row(Luma, row), luma_, count, out.y);
    smoothColumn(planes.row(RedGreen, row), redGreen_, count, out.cx);
    // A sum of two Gaussians; each of them is separable, their sum is not.
    smoothColumn(planes.row(BlueYellow, row), blueYellow_, count, out.cz);
    smoothColumn(planes.row(BlueYellowSecond, row), blueYellowSecond_, count, buffers.second);
    for (size_t x = 0; x < count; ++x)
        out.cz[x] = buffers.second[x] + blueYellowShare_ * (out.cz[x] - buffers.second[x]);
}

void LinearFlip::compareTile(const Image& test, const Image& reference, const Tile& tile, Workspace& work,
                             Image& map) const {
    filterRows(test, tile, work.padded, work.testPlanes);
    filterRows(reference, tile, work.padded, work.referencePlanes);
    const size_t count = flipPadded(tile.width);
    for (size_t y = 0; y < tile.height; ++y) {
        filterColumns(work.testPlanes, y + margin_, count, work.test);
        filterColumns(work.referencePlanes, y + margin_, count, work.reference);
        flipRows().errors(work.test.row, work.reference.row, largest_, count, work.errors.data());
        float* const to = &map.pixels[(tile.top + y) * width_ + tile.left];
        for (size_t x = 0; x < tile.width; ++x) to[x] = std::max(to[x], work.errors[x]);
    }
}

void LinearFlip::compare(const Image& test, const Image& reference, Image& map) const {
    checkComparable(test, reference);
    const size_t across = (width_ + tileWidth - 1) / tileWidth,
                 down = (height_ + tileHeight - 1) / tileHeight;
    tbb::enumerable_thread_specific<Workspace> workspaces(margin_);
    tbb::parallel_for(size_t{0}, across * down, [&](size_t i) {
        const size_t left = i % across * tileWidth, top = i / across * tileHeight;
        compareTile(test, reference,
                    {left, top, std::min(tileWidth, width_ - left), std::min(tileHeight, height_ - top)},
                    workspaces.local(), map);
    });
}

Image flip(const Image& test, const Image& reference, double pixelsPerDegree) {
    checkComparable(test, reference);
    Image map(test.width, test.height, 1, 0.0f);
    LinearFlip(test.width, test.height, pixelsPerDegree).compare(decode(test), decode(reference), map);
    return map;
}

}  // namespace limpid::image
