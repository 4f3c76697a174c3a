// Text inside pictures, for strips that are looked at without their table.
#pragma once

#include <string>
#include <vector>

#include "image/io/png/png.h"

namespace limpid::cli {

/// A rectangle of a picture, pixels.
struct LabelPlace {
    uint32_t x = 0, y = 0, width = 0, height = 0;
};

/// Writes lines at the top left of `place`, light on a darkened band that is as wide as the longest line. The
/// letters are those of stb_easy_font, enlarged by a whole factor: the largest with which the lines take at
/// most the width and a quarter of the height, at least 1. Text beyond the place is cut off. ASCII; other
/// bytes become '?'.
void drawLabel(image::ByteImage& picture, const LabelPlace& place, const std::vector<std::string>& lines);

}  // namespace limpid::cli
