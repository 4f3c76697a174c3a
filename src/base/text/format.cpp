#include "base/text/format.h"

#include <array>
#include <charconv>
#include <cmath>

namespace limpid {
namespace {

template <typename T>
std::string shortest(T value) {
    // Use powers of ten only for numbers that would have many zeros.
    const T magnitude = std::abs(value);
    const bool plain =
        magnitude == 0 || (magnitude >= static_cast<T>(1e-4) && magnitude < static_cast<T>(1e16));
    std::array<char, 64> buffer;
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                            plain ? std::chars_format::fixed : std::chars_format::scientific);
    return error == std::errc() ? std::string(buffer.data(), end) : std::string("?");
}

}  // namespace

std::string detail::numberText(double value) {
    return shortest(value);
}

std::string detail::numberText(float value) {
    return shortest(value);
}

std::string detail::replacePlaceholders(std::string_view pattern, const std::vector<std::string>& arguments) {
    std::string result;
    size_t next = 0;
    while (true) {
        const size_t hole = pattern.find("{}");
        if (hole == std::string_view::npos || next == arguments.size()) return result.append(pattern);
        result.append(pattern.substr(0, hole)).append(arguments[next++]);
        pattern.remove_prefix(hole + 2);
    }
}

std::string joinText(const std::vector<std::string>& parts, std::string_view separator) {
    std::string result;
    for (const std::string& part : parts) {
        if (!result.empty()) result += separator;
        result += part;
    }
    return result;
}

std::string countText(uint64_t count, std::string_view noun) {
    return formatText(count == 1 ? "{} {}" : "{} {}s", count, noun);
}

}  // namespace limpid
