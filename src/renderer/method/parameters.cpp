#include "renderer/method/parameters.h"

#include <algorithm>

#include "base/error.h"
#include "base/text/nearest_name.h"

namespace limpid {
namespace {

/// `select` returns the technique's settings within RenderSettings.
template <typename Settings, typename Select>
ParamGroup groupOf(const ParamTable<Settings>& table, Select select) {
    return {
        .name = table.group(),
        .infos = table.infos(),
        .set = [&table, select](RenderSettings& settings, std::string_view name,
                                std::string_view text) { return table.set(select(settings), name, text); },
        .get = [&table, select](const RenderSettings& settings,
                                size_t index) { return table.get(select(settings), index); }};
}

std::vector<std::string> parameterNames() {
    std::vector<std::string> names;
    for (const ParamGroup& group : paramGroups())
        for (const ParamInfo& info : group.infos) names.push_back(group.name + "." + info.name);
    return names;
}

}  // namespace

const std::vector<ParamGroup>& paramGroups() {
    static const std::vector<ParamGroup> all = [] {
        std::vector<ParamGroup> groups;
        const auto add = [&](const auto& table, auto select) { groups.push_back(groupOf(table, select)); };
        add(
            pathtraceParams(), [](auto& s) -> auto& { return s.pathtrace; });
        add(
            gbufferParams(), [](auto& s) -> auto& { return s.gbuffer; });
        add(
            ambientOcclusionParams(), [](auto& s) -> auto& { return s.ambientOcclusion; });
#define LIMPID_ADD(method) \
    add(                   \
        denoise::method::params(), [](auto& s) -> auto& { return s.denoisers.method; });
        LIMPID_METHODS(LIMPID_ADD)
#undef LIMPID_ADD
        add(
            denoise::kpcnParams(), [](auto& s) -> auto& { return s.denoisers.kpcn; });
        add(
            denoise::taaParams(), [](auto& s) -> auto& { return s.denoisers.taa; });
        return groups;
    }();
    return all;
}

void assign(RenderSettings& settings, std::string_view assignment) {
    const Assignment a = parseAssignment(assignment);
    for (const ParamGroup& group : paramGroups()) {
        if (group.name == a.group && group.set(settings, a.name, a.value)) return;
    }
    const std::vector<std::string> names = parameterNames();
    const std::string meant = didYouMean(a.group + "." + a.name, names);
    throw UsageError("there is no parameter '" + a.group + "." + a.name + "'" +
                     (meant.empty() ? "; 'limpid info' lists them" : meant));
}

std::vector<std::string_view> groupsOf(const Pipeline& pipeline) {
    // Its generator of random numbers is that of all integrators.
    std::vector<std::string_view> groups{pathtraceParams().group()};
    const bool occlusion = pipeline.integrator == Integrator::AmbientOcclusion;
    if (occlusion) groups.emplace_back(ambientOcclusionParams().group());
    if (occlusion || pipeline.integrator == Integrator::GBuffer) groups.emplace_back(gbufferParams().group());
    if (pipeline.denoiser)
        groups.insert(groups.end(), pipeline.denoiser->groups.begin(), pipeline.denoiser->groups.end());
    return groups;
}

void checkTakesPart(std::span<const std::string_view> groups, std::string_view assignment,
                    std::string_view owner) {
    const std::string group = parseAssignment(assignment).group;
    if (std::find(groups.begin(), groups.end(), group) != groups.end()) return;
    std::string list;
    for (const std::string_view each : groups) list += " " + std::string(each);
    throw UsageError("--set " + std::string(assignment) + ": " + std::string(owner) +
                     " has no parameters of this group; it has those of" + list);
}

std::vector<std::string> assignmentsOf(const RenderSettings& settings) {
    std::vector<std::string> texts;
    for (const ParamGroup& group : paramGroups()) {
        for (size_t i = 0; i < group.infos.size(); ++i) {
            const ParamValue value = group.get(settings, i);
            if (value != group.infos[i].defaultValue)
                texts.push_back(group.name + "." + group.infos[i].name + "=" + toString(value));
        }
    }
    return texts;
}

}  // namespace limpid
