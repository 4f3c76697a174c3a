#include "denoise/api/parameter_numbers.h"

#include <cmath>

#include "base/error.h"
#include "base/text/format.h"

namespace limpid::denoise {

limpid_parameter describe(const InstanceParameter& parameter) {
    const ParamValue& value = parameter.info.defaultValue;
    return {parameter.name.c_str(),
            std::holds_alternative<bool>(value)  ? LIMPID_PARAMETER_BOOL
            : std::holds_alternative<int>(value) ? LIMPID_PARAMETER_INT
                                                 : LIMPID_PARAMETER_FLOAT,
            toNumber(value),
            parameter.info.minimum,
            parameter.info.maximum,
            parameter.info.unit.c_str(),
            parameter.info.help.c_str()};
}

bool isParameter(const std::string& group, const ParamInfo& info, std::string_view name) {
    return name.size() == group.size() + 1 + info.name.size() && name.starts_with(group) &&
           name[group.size()] == '.' && name.ends_with(info.name);
}

std::string valueText(const ParamInfo& info, std::string_view name, double value) {
    if (!(value >= info.minimum && value <= info.maximum))
        throw UsageError(
            formatText("{}: {} is outside its range {} to {}", name, value, info.minimum, info.maximum));
    if (std::holds_alternative<float>(info.defaultValue)) return formatText("{}", static_cast<float>(value));
    if (value != std::floor(value)) {
        const bool isBool = std::holds_alternative<bool>(info.defaultValue);
        throw UsageError(
            formatText("{}: {} is {}", name, value, isBool ? "neither 0 nor 1" : "not a whole number"));
    }
    return formatText("{}", static_cast<int>(value));
}

double toNumber(const ParamValue& value) {
    return std::visit([](auto v) { return static_cast<double>(v); }, value);
}

}  // namespace limpid::denoise
