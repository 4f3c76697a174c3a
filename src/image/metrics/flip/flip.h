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

    /// Raises each pixel of `map`, an image of one component, to its error where that is larger.
    void compare(const Image& test, const Image& reference, Image& map) const;

  private:
    /// Weights at 1, 2, .. of a symmetric or antisymmetric filter; the middle weight follows from their sum.
    struct Weights {
        std::vector<float> values;  ///< zero-padded after `reach` to the length of the longest filter
        size_t reach;
    };
    /// The results of filtering along rows, which are then filtered along columns.
    enum Plane { Edge, Smooth, Point, Luma, RedGreen, BlueYellow, BlueYellowSecond, PlaneCount };
    /// The part of the pictures that is compared at once.
    struct Tile {
        size_t left, top;
        size_t width, height;  ///< inside the picture
    };
    struct Planes;
    struct RowBuffers;
    struct Workspace;

    void compareTile(const Image& test, const Image& reference, const Tile& tile, Workspace& work,
                     Image& map) const;
    void filterRows(const Image& picture, const Tile& tile, std::vector<float>& padded, Planes& planes) const;
    void filterRow(const float* rgb, const Tile& tile, std::vector<float>& padded, Planes& planes,
                   size_t row) const;
    void filterColumns(const Planes& planes, size_t row, size_t count, RowBuffers& buffers) const;
    void smoothColumn(const float* column, const Weights& weights, size_t count, float* result) const;
    Weights zeroPadded(std::vector<float> values) const;

    size_t width_, height_;
    size_t stride_;  ///< distance of rows, in values
    size_t margin_;  ///< pixels added around the picture, at least the radius of the longest filter
    Weights smooth_, edge_, point_, luma_, redGreen_, blueYellow_, blueYellowSecond_;
    float blueYellowShare_ = 1.0f;  ///< weight of the first of the two blue-yellow Gaussians
    float largest_ = 1.0f;          ///< the largest distance of two colours: green to blue
};

}  // namespace limpid::image
