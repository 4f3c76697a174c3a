// Images of passes for clients: as pictures, as the values of a pixel, and motion as a grid.
#pragma once

#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/math.h"
#include "studio/compare/inspector.h"
#include "studio/picture.h"

namespace limpid::serve {

/// The inspected image as a picture, made anew only when the image or the view has changed.
class InspectedPicture {
  public:
    std::shared_ptr<const studio::Picture> of(const std::shared_ptr<const image::Image>& image,
                                              const studio::InspectorView& view);

  private:
    std::shared_ptr<const image::Image> image_;
    studio::InspectorView view_;
    std::shared_ptr<const studio::Picture> picture_;
};

/// `pixel`: column and row; `values`: of all its components, as numbers, or "nan", "inf" and "-inf", which
/// JSON has not. An empty object where there is no image. `position`: from 0 to 1.
nlohmann::json valuesAt(const image::Image* image, const std::array<float, 2>& position);

/// Where things came from, at the centres of a regular grid over the picture.
struct MotionGrid {
    uint16_t columns = 0, rows = 0;
    std::vector<vec2> offsets;  ///< to the place in the frame before, in shares of the picture; 0: at rest
};
/// A cell for every 32 pixels of the viewport, with what studio::motionAt() says of its centre. An image
/// without pixels gives a grid without cells.
MotionGrid motionGrid(const image::Image& motion, gpu::Extent viewport);
/// Two floats for each cell, little endian, row by row.
std::vector<std::byte> packed(const MotionGrid& grid);

}  // namespace limpid::serve
