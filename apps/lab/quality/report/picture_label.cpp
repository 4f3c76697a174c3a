#include "lab/quality/report/picture_label.h"

#include <stb/stb_easy_font.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace limpid::cli {
namespace {

constexpr uint32_t lineHeight = 12, margin = 2;  ///< units of stb_easy_font

/// A corner as stb_easy_font writes it; four make a rectangle.
struct Corner {
    float x, y, z;
    std::array<uint8_t, 4> color;
};

/// The letters of a line as rectangles, in units from its upper left corner.
std::vector<LabelPlace> inkOf(std::string line) {
    for (char& letter : line) {
        if (letter < ' ' || letter > '~') letter = '?';
    }
    std::vector<Corner> corners(4 * 64 * line.size());
    const int quads = stb_easy_font_print(0.0f, 0.0f, line.data(), nullptr, corners.data(),
                                          static_cast<int>(corners.size() * sizeof(Corner)));
    std::vector<LabelPlace> ink;
    for (size_t i = 0; i < static_cast<size_t>(quads); ++i) {
        const Corner &low = corners[4 * i], &high = corners[4 * i + 2];
        ink.push_back({static_cast<uint32_t>(std::lround(low.x)), static_cast<uint32_t>(std::lround(low.y)),
                       static_cast<uint32_t>(std::lround(high.x - low.x)),
                       static_cast<uint32_t>(std::lround(high.y - low.y))});
    }
    return ink;
}

uint32_t widthOf(std::string line) {
    return static_cast<uint32_t>(stb_easy_font_width(line.data()));
}

/// Changes the components of the pixels of `part` that lie in `place`.
template <typename Change>
void change(image::ByteImage& picture, const LabelPlace& place, const LabelPlace& part, const Change& how) {
    const uint32_t right = std::min(part.x + part.width, place.width),
                   bottom = std::min(part.y + part.height, place.height);
    for (uint32_t y = part.y; y < bottom; ++y) {
        for (uint32_t x = part.x; x < right; ++x) {
            uint8_t* const pixel =
                &picture.pixels[(size_t{place.y + y} * picture.width + place.x + x) * picture.components];
            for (uint32_t c = 0; c < 3; ++c) pixel[c] = how(pixel[c]);
        }
    }
}

}  // namespace

void drawLabel(image::ByteImage& picture, const LabelPlace& place, const std::vector<std::string>& lines) {
    uint32_t columns = 0;
    for (const std::string& line : lines) columns = std::max(columns, widthOf(line));
    columns += 2 * margin;
    const uint32_t rows = static_cast<uint32_t>(lines.size()) * lineHeight + margin;
    const uint32_t scale = std::max(1u, std::min(place.width / columns, place.height / 4 / rows));
    change(picture, place, {0, 0, columns * scale, rows * scale},
           [](uint8_t value) { return static_cast<uint8_t>(value / 4); });
    for (size_t line = 0; line < lines.size(); ++line) {
        const uint32_t top = margin + static_cast<uint32_t>(line) * lineHeight;
        for (const LabelPlace& ink : inkOf(lines[line]))
            change(picture, place,
                   {(margin + ink.x) * scale, (top + ink.y) * scale, ink.width * scale, ink.height * scale},
                   [](uint8_t) { return uint8_t{255}; });
    }
}

}  // namespace limpid::cli
