#include "base/params.h"

#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/text/format.h"

namespace limpid {
namespace {

template <typename T>
T parseNumber(std::string_view name, std::string_view text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
        throw UsageError(formatText("{}: '{}' is not {}", name, text,
                                    std::is_same_v<T, int> ? "a whole number" : "a number"));
    }
    return value;
}

bool parseBool(std::string_view name, std::string_view text) {
    if (text == "1" || text == "true" || text == "on") return true;
    if (text == "0" || text == "false" || text == "off") return false;
    throw UsageError(formatText("{}: '{}' is neither on nor off", name, text));
}

double asDouble(const ParamValue& value) {
    return std::visit([](auto v) { return static_cast<double>(v); }, value);
}

}  // namespace

ParamValue parseParam(std::string_view name, std::string_view text, const ParamValue& like) {
    if (std::holds_alternative<bool>(like)) return parseBool(name, text);
    if (std::holds_alternative<int>(like)) return parseNumber<int>(name, text);
    return parseNumber<float>(name, text);
}

std::string toString(const ParamValue& value) {
    if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "on" : "off";
    return std::visit([](auto v) { return formatText("{}", v); }, value);
}

void checkRange(std::string_view group, const ParamInfo& info, const ParamValue& value) {
    // Compare with the range's end rounded to float: 1e-4 as a float is below 1e-4.
    const bool isFloat = std::holds_alternative<float>(value);
    const auto end = [&](double bound) {
        return isFloat ? static_cast<double>(static_cast<float>(bound)) : bound;
    };
    const double number = asDouble(value);
    if (!(std::isfinite(number) && number >= end(info.minimum) && number <= end(info.maximum))) {
        throw UsageError(formatText("{}.{}: {} is outside its range {} to {}", group, info.name,
                                    toString(value), info.minimum, info.maximum));
    }
}

Assignment parseAssignment(std::string_view text) {
    const size_t equals = text.find('=');
    const size_t dot = text.substr(0, equals).find('.');
    if (equals == std::string_view::npos || dot == std::string_view::npos || dot == 0 || dot + 1 == equals) {
        throw UsageError(formatText("'{}' is not of the form group.name=value", text));
    }
    return {std::string(text.substr(0, dot)), std::string(text.substr(dot + 1, equals - dot - 1)),
            std::string(text.substr(equals + 1))};
}

}  // namespace limpid
