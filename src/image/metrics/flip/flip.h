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

    /// Sets `map`, an image of one component, to the error of each pixel.
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
    struct Band;
    struct RowBuffers;

    void compareBand(const Image& test, const Image& reference, size_t begin, size_t end, Image& map) const;
    Band filterRows(const Image& picture, size_t begin, size_t end) const;
    void filterRow(const float* rgb, std::vector<float>& padded, const Band& band, int64_t y) const;
    void filterColumns(const Band& band, int64_t y, RowBuffers& buffers) const;
    void smoothColumn(const Band& band, int plane, const Weights& weights, int64_t y, float* result) const;
    Weights zeroPadded(std::vector<float> values) const;

    size_t width_, height_;
    size_t stride_;  ///< of rows
    size_t margin_;  ///< of pixels around the picture, at least as many as filters reach
    Weights smooth_, edge_, point_, luma_, redGreen_, blueYellow_, blueYellowSecond_;
    float blueYellowShare_ = 1.0f;  ///< of the first of the two
    float largest_ = 1.0f;          ///< distance of two colours: green to blue
};

}  // namespace limpid::image
