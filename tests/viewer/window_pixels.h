// Reads the window's pixels as X shows them, with the helper window_pixels.
#pragma once

#ifdef LIMPID_WINDOW_PIXELS

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include "image/image.h"
#include "tests/viewer/driven_viewer.h"

namespace limpid {

/// The window's pixels as X shows them.
class WindowPixels {
  public:
    WindowPixels(const DrivenViewer& viewer, const fs::path& file) {
        viewer.run(std::string("'") + LIMPID_WINDOW_PIXELS + "' " + viewer.window() + " > '" + file.string() +
                   "'");
        std::ifstream stream(file, std::ios::binary);
        std::string magic;
        int most = 0;
        stream >> magic >> width_ >> height_ >> most;
        stream.get();
        bytes_.assign(std::istreambuf_iterator<char>(stream), {});
    }
    /// Returns the largest difference of a channel, in steps of 1/255, from a pixel of an encoded picture.
    int difference(uint32_t x, uint32_t y, const image::Image& picture, uint32_t px, uint32_t py) const {
        int most = 0;
        for (uint32_t c = 0; c < 3; ++c) {
            const auto shown = static_cast<unsigned char>(bytes_.at(3 * (size_t{y} * width_ + x) + c));
            most = std::max(
                most, std::abs(int{shown} - static_cast<int>(std::lround(255.0f * picture.at(px, py, c)))));
        }
        return most;
    }
    /// The mean of the three channels, 0 to 255.
    double brightness(uint32_t x, uint32_t y) const {
        double sum = 0.0;
        for (uint32_t c = 0; c < 3; ++c)
            sum += static_cast<unsigned char>(bytes_.at(3 * (size_t{y} * width_ + x) + c));
        return sum / 3.0;
    }
    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }

  private:
    uint32_t width_ = 0, height_ = 0;
    std::string bytes_;
};

}  // namespace limpid

#endif
