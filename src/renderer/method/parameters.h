// Every technique's parameters in one place: for --set, `limpid info` and the viewer.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/params.h"
#include "renderer/method/settings.h"

namespace limpid {

/// A technique's ParamTable, applied to its settings inside RenderSettings.
struct ParamGroup {
    std::string name;
    std::vector<ParamInfo> infos;
    /// Like ParamTable::set() and get().
    std::function<bool(RenderSettings&, std::string_view name, std::string_view text)> set;
    std::function<ParamValue(const RenderSettings&, size_t index)> get;
};

const std::vector<ParamGroup>& paramGroups();

/// "group.name=value". Throws UsageError if there is no such parameter, or on a bad value.
void assign(RenderSettings& settings, std::string_view assignment);

/// The groups whose parameters change what the pipeline computes.
std::vector<std::string_view> groupsOf(const Pipeline& pipeline);

/// Throws UsageError, naming `owner`, if the parameter of this assignment belongs to none of the groups.
void checkTakesPart(std::span<const std::string_view> groups, std::string_view assignment,
                    std::string_view owner);

/// The assignments that turn the defaults into these settings, for assign().
std::vector<std::string> assignmentsOf(const RenderSettings& settings);

}  // namespace limpid
