#include "base/text/bytes_text.h"

#include <array>
#include <cstdio>
#include <iterator>

namespace limpid {

std::string bytesText(uint64_t bytes) {
    constexpr const char* units[] = {"bytes", "KiB", "MiB", "GiB"};
    double value = static_cast<double>(bytes);
    size_t unit = 0;
    for (; value >= 1024.0 && unit + 1 < std::size(units); ++unit) value /= 1024.0;
    if (unit == 0) return std::to_string(bytes) + " bytes";
    std::array<char, 32> number;
    std::snprintf(number.data(), number.size(), "%.1f ", value);
    return std::string(number.data()) + units[unit];
}

}  // namespace limpid
