// LDR-FLIP on linear display values, shared by flip() and hdrFlip(). Private to src/image; the public
// functions are in image/metrics/metrics.h.
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"

namespace limpid::image {

/// Computes LDR-FLIP maps of linear display values in [0,1]. HDR-FLIP tone-maps to such values directly,
/// without the sRGB encoding that flip() would have to undo.
class LinearFlip {
  public:
    /// All images must have this size.
    LinearFlip(uint32_t width, uint32_t height, double pixelsPerDegree);

    /// Sets `map`, an image of one component, to the error of each pixel.
    void compare(const Image& test, const Image& reference, Image& map) const;

  private:
    /// Weights at 1, 2, .. of a symmetric or antisymmetric filter; the middle weight follows from their sum.
    struct Weights {
        std::vector<float> values;  ///< zero-padded after `reach` to the length of the longest filter
        size_t reach;
    };
    /// The results of filtering along rows, which are then filtered along columns.
    enum Plane { Edge, Smooth, Point, Luma, RedGreen, BlueYellow, BlueYellowSecond, PlaneCount };
    struct Band;
    struct RowBuffers;

    void compareBand(const Image& test, const Image& reference, size_t begin, size_t end, Image& map) const;
    Band filterRows(const Image& picture, size_t begin, size_t end) const;
    void filterRow(const float* rgb, std::vector<float>& padded, const Band& band, int64_t y) const;
    void filterColumns(const Band& band, int64_t y, RowBuffers& buffers) const;
    void smoothColumn(const Band& band, int plane, const Weights& weights, int64_t y, float* result) const;
    Weights zeroPadded(std::vector<float> values) const;

    size_t width_, height_;
    size_t stride_;  ///< distance of rows, in values
    size_t margin_;  ///< pixels added around the picture, at least the radius of the longest filter
    Weights smooth_, edge_, point_, luma_, redGreen_, blueYellow_, blueYellowSecond_;
    float blueYellowShare_ = 1.0f;  ///< weight of the first of the two blue-yellow Gaussians
    float largest_ = 1.0f;          ///< the largest distance of two colours: green to blue
};

}  // namespace limpid::image
