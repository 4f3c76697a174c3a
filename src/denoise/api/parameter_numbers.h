// Parameters as the C interfaces have them: numbers under whole names ("svgf.alpha").
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/params.h"
#include "limpid/denoise.h"

namespace limpid::denoise {

/// One parameter, in its table.
struct InstanceParameter {
    std::string name;  ///< "svgf.alpha"
    ParamInfo info;
};

/// Its strings are those of `parameter`.
limpid_parameter describe(const InstanceParameter& parameter);

/// Whether this is the parameter `info` of `group`.
bool isParameter(const std::string& group, const ParamInfo& info, std::string_view name);

/// As ParamTable::set() takes it. Throws UsageError if the value is outside its range, or a fraction where
/// the parameter is an int or a bool.
std::string valueText(const ParamInfo& info, std::string_view name, double value);

double toNumber(const ParamValue& value);

template <typename Settings>
void listParameters(const ParamTable<Settings>& table, std::vector<InstanceParameter>& all) {
    for (const ParamInfo& info : table.infos()) all.push_back({table.group() + "." + info.name, info});
}

/// Returns false if the table has no such parameter.
template <typename Settings>
bool setNumber(const ParamTable<Settings>& table, Settings& settings, std::string_view name, double value) {
    for (const ParamInfo& info : table.infos()) {
        if (isParameter(table.group(), info, name))
            return table.set(settings, info.name, valueText(info, name, value));
    }
    return false;
}

template <typename Settings>
std::optional<double> getNumber(const ParamTable<Settings>& table, const Settings& settings,
                                std::string_view name) {
    for (size_t i = 0; i < table.infos().size(); ++i) {
        if (isParameter(table.group(), table.infos()[i], name)) return toNumber(table.get(settings, i));
    }
    return std::nullopt;
}

}  // namespace limpid::denoise
