// Floats from JSON, whose numbers are doubles.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace limpid {

/// Returns the value as a float; none if it is no number, not finite, or beyond the range of float, where the
/// conversion would be undefined. Within the range are doubles that round to the largest float: programs
/// write that as 3.4028235e38, which is a little more. `Json` is nlohmann::json, which this library does
/// without.
template <typename Json>
std::optional<float> finiteFloat(const Json& value) {
    if (!value.is_number()) return std::nullopt;
    const double number = value.template get<double>();
    constexpr auto largest = static_cast<double>(std::numeric_limits<float>::max());
    constexpr double tooLarge = 0x1.ffffffp127;  // half a step beyond the largest
    if (!(std::abs(number) < tooLarge)) return std::nullopt;
    return static_cast<float>(std::clamp(number, -largest, largest));
}

}  // namespace limpid
