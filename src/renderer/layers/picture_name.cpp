#include "renderer/layers/picture_name.h"

#include <charconv>
#include <cmath>
#include <string_view>

#include "base/error.h"
#include "base/files/file.h"

namespace limpid {

std::optional<float> parseExposure(const std::string& text) {
    if (text == "auto") return std::nullopt;
    const bool plus = text.starts_with('+') && !text.starts_with("+-");
    const std::string_view number = std::string_view(text).substr(plus ? 1 : 0);
    float stops = 0.0f;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), stops);
    // 2^stops, and radiance multiplied by it, must stay within the range of a float.
    if (error != std::errc{} || end != number.data() + number.size() || !(std::abs(stops) <= 60.0f)) {
        throw UsageError("--exposure: '" + text + "' is neither 'auto' nor a number of stops from -60 to 60");
    }
    return stops;
}

bool isExr(const std::filesystem::path& path) {
    return path.extension() == ".exr";
}

void checkPictureOutput(const std::filesystem::path& path) {
    if (!isExr(path) && path.extension() != ".png")
        throw UsageError("'" + path.string() + "': an output's name ends in .exr or .png");
    checkWritable(path);
}

}  // namespace limpid
