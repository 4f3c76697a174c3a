#include "renderer/frame/parameters.h"

#include "base/error.h"

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
    throw UsageError("there is no parameter '" + a.group + "." + a.name + "'; 'limpid info' lists them");
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
