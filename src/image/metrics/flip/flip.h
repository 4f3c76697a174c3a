// LDR-FLIP where it meets HDR-FLIP. Private to src/image; image/metrics/metrics.h is the public face.
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"

namespace limpid::image {

/// flip() of images that are not encoded: linear display values in [0,1]. Saves HDR-FLIP an encoding that
/// LDR-FLIP would undo at once.
class LinearFlip {
  public:
    /// For images of this size.
    LinearFlip(uint32_t width, uint32_t height, double pixelsPerDegree);

    /// Raises each pixel of `map`, an image of one component, to its error where that is larger.
    void compare(const Image& test, const Image& reference, Image& map) const;

  private:
    /// The weights at 1, 2 .. of filters that are symmetric or antisymmetric; their middle follows from their
    /// sum.
    struct Weights {
        std::vector<float> values;  ///< zeros behind `reach`, as many as the longest filter needs
        size_t reach;
    };
    /// What rows are filtered to before columns are: filters, and the plane that they look at.
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
    size_t margin_;  ///< of pixels around the picture, at least as many as filters reach
    Weights smooth_, edge_, point_, luma_, redGreen_, blueYellow_, blueYellowSecond_;
    float blueYellowShare_ = 1.0f;  ///< of the first of the two
    float largest_ = 1.0f;          ///< distance of two colours: green to blue
};

}  // namespace limpid::image
