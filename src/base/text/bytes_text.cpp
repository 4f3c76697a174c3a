#include "base/text/bytes_text.h"

#include <fmt/format.h>

#include <iterator>

namespace limpid {

std::string bytesText(uint64_t bytes) {
    constexpr const char* units[] = {"bytes", "KiB", "MiB", "GiB"};
    double value = static_cast<double>(bytes);
    size_t unit = 0;
    for (; value >= 1024.0 && unit + 1 < std::size(units); ++unit) value /= 1024.0;
    return unit == 0 ? fmt::format("{} bytes", bytes) : fmt::format("{:.1f} {}", value, units[unit]);
}

}  // namespace limpid
