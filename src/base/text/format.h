// Formats messages without {fmt}: the denoising library has no dependency but Vulkan.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace limpid {

namespace detail {

std::string numberText(double value);
std::string numberText(float value);
template <typename T>
std::string argumentText(const T& value) {
    if constexpr (std::convertible_to<const T&, std::string_view>)
        return std::string(std::string_view(value));
    else if constexpr (std::same_as<T, bool>)
        return value ? "true" : "false";
    else if constexpr (std::same_as<T, char>)
        return std::string(1, value);
    else if constexpr (std::floating_point<T>)
        return numberText(value);
    else
        return std::to_string(value);
}

/// Returns `pattern` with its "{}" replaced by `arguments`, in order.
std::string replacePlaceholders(std::string_view pattern, const std::vector<std::string>& arguments);

}  // namespace detail

/// formatText("{} of {}", 1, "two") returns "1 of two". {} is the only placeholder. Numbers are printed with
/// the fewest digits that distinguish them from all others of their type.
template <typename... Args>
std::string formatText(std::string_view pattern, const Args&... args) {
    return detail::replacePlaceholders(pattern, {detail::argumentText(args)...});
}

/// Returns "a, b, c".
std::string joinText(const std::vector<std::string>& parts, std::string_view separator = ", ");

/// Returns "1 sample", "2 samples".
std::string countText(uint64_t count, std::string_view noun);

}  // namespace limpid
