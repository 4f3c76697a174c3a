// Floats from JSON, whose numbers are doubles.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

namespace limpid {

/// Returns the value as a float; none if it is no number, not finite, or beyond the range of float, where the
/// conversion would be undefined. `Json` is nlohmann::json, which this library does without.
template <typename Json>
std::optional<float> finiteFloat(const Json& value) {
    if (!value.is_number()) return std::nullopt;
    const double number = value.template get<double>();
    if (!(std::abs(number) <= static_cast<double>(std::numeric_limits<float>::max()))) return std::nullopt;
    return static_cast<float>(number);
}

}  // namespace limpid
