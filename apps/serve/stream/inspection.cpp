#include "serve/stream/inspection.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "studio/compare/motion_sample.h"

namespace limpid::serve {
namespace {

using nlohmann::json;

constexpr float spacing = 32.0f;  ///< pixels of the viewport between two arrows

uint32_t pixelAt(float share, uint32_t length) {
    return std::min(static_cast<uint32_t>(share * static_cast<float>(length)), length - 1);
}

json numberOf(float value) {
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value > 0.0f ? "inf" : "-inf";
    return value;
}

uint16_t cellsAlong(uint32_t pixels) {
    return static_cast<uint16_t>(std::max(std::lround(static_cast<float>(pixels) / spacing), 1l));
}

}  // namespace

std::shared_ptr<const studio::Picture> InspectedPicture::of(const std::shared_ptr<const image::Image>& image,
                                                            const studio::InspectorView& view) {
    if (image_ != image || view_ != view) {
        picture_ = std::make_shared<const studio::Picture>(
            studio::Picture{{image->width, image->height}, studio::shownTexels(*image, view)});
        image_ = image;
        view_ = view;
    }
    return picture_;
}

json valuesAt(const image::Image* image, const std::array<float, 2>& position) {
    if (!image || image->width == 0 || image->height == 0) return json::object();
    const uint32_t column = pixelAt(position[0], image->width), row = pixelAt(position[1], image->height);
    json values = json::array();
    for (uint32_t c = 0; c < image->components; ++c) values.push_back(numberOf(image->at(column, row, c)));
    return {{"pixel", {column, row}}, {"values", std::move(values)}};
}

MotionGrid motionGrid(const image::Image& motion, gpu::Extent viewport) {
    MotionGrid grid;
    if (motion.width == 0 || motion.height == 0) return grid;
    grid.columns = cellsAlong(viewport.width);
    grid.rows = cellsAlong(viewport.height);
    const vec2 cells(grid.columns, grid.rows), pixels(motion.width, motion.height);
    for (uint32_t row = 0; row < grid.rows; ++row) {
        for (uint32_t column = 0; column < grid.columns; ++column)
            grid.offsets.push_back(studio::motionAt(motion, (vec2(column, row) + 0.5f) / cells) / pixels);
    }
    return grid;
}

std::vector<std::byte> packed(const MotionGrid& grid) {
    std::vector<std::byte> bytes;
    bytes.reserve(grid.offsets.size() * 8);
    for (const vec2 offset : grid.offsets) {
        for (const float value : {offset.x, offset.y}) {
            const auto bits = std::bit_cast<uint32_t>(value);
            for (int shift = 0; shift < 32; shift += 8)
                bytes.push_back(static_cast<std::byte>(bits >> shift & 0xff));
        }
    }
    return bytes;
}

}  // namespace limpid::serve
