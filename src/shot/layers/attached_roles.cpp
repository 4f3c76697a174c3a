#include "shot/layers/attached_roles.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "base/error.h"

namespace limpid::shot {
namespace {

/// The component that holds a single value: the only one, or a usual one. Grey pictures have R, G and B, and
/// files of colours may be given for their alpha.
std::string singleComponent(const RoleInfo& role, const LayerChannels& layer) {
    if (layer.components.size() == 1) return layer.components.front();
    constexpr std::array usual{"A", "Z", "Y", "R"};
    const auto* const first = usual.begin() + (role.name == "alpha" ? 0 : 1);
    const auto* const found = std::find_if(first, usual.end(), [&](const char* name) {
        return std::find(layer.components.begin(), layer.components.end(), name) != layer.components.end();
    });
    return found == usual.end() ? "" : *found;
}

/// Those that a role reads of a layer; other names of them are found, too.
std::string componentsOf(const RoleInfo& role, const LayerChannels& layer) {
    if (role.components == 1) return singleComponent(role, layer);
    if (role.components == 2) return "XY";
    return role.values == RoleValues::Colors ? "RGB" : "XYZ";
}

/// A layer of an attached part that fits a role.
struct FittingLayer {
    std::string layer;
    LayerExpression expression;
};

std::vector<FittingLayer> candidatesFor(const RoleInfo& role, size_t part, const ChannelTable& table) {
    std::vector<FittingLayer> result;
    for (const AttachedLayer& layer : table.attached()) {
        if (layer.part != part) continue;
        const std::string components = componentsOf(role, layer.channels);
        if (components.empty()) continue;
        auto expression = LayerExpression::resolve(joined(layer.channels.name, components), table);
        if (!expression || expression->components() != role.components) continue;
        const std::vector<ChannelPlace> places = expression->places();
        // The file may have a layer of this name, too.
        if (std::all_of(places.begin(), places.end(), [&](const auto& place) { return place.part == part; }))
            result.push_back({layer.channels.name, std::move(*expression)});
    }
    return result;
}

/// Chooses as addAttachedRoles() says. None if the choice is not clear: the layer without a name may be the
/// beauty of a file that has all layers.
const FittingLayer* clearChoice(const std::vector<FittingLayer>& candidates, std::string_view role) {
    const FittingLayer* named = nullptr;
    for (const FittingLayer& candidate : candidates) {
        if (candidate.layer == role || split(candidate.layer).component != role) continue;
        if (named) return nullptr;
        named = &candidate;
    }
    if (named) return named;
    return candidates.size() == 1 ? &candidates.front() : nullptr;
}

std::string_view componentsText(uint32_t count) {
    if (count == 1) return "one component";
    return count == 2 ? "two components" : "three components";
}

/// Why nothing reads an attached part.
std::string whyUnused(const AttachedLayer& layer, const ChannelTable& table) {
    const RoleInfo* const role = findRole(layer.partName);
    if (!role)
        return fmt::format("'{}' is no layer that is known; --map albedo={}.RGB would make it the albedo",
                           layer.partName, layer.channels.name);
    const std::vector<FittingLayer> candidates = candidatesFor(*role, layer.part, table);
    if (candidates.empty())
        return fmt::format("it has no layer with {}, which '{}' needs", componentsText(role->components),
                           role->name);
    if (clearChoice(candidates, role->name)) return fmt::format("--map {} names another layer", role->name);
    std::vector<std::string> names;
    for (const FittingLayer& candidate : candidates) names.push_back(candidate.expression.text());
    return fmt::format("several of its layers fit ({}); --map {}={} chooses one", fmt::join(names, ", "),
                       role->name, names.front());
}

}  // namespace

void addAttachedRoles(const ChannelTable& table, LayerMap& map) {
    for (const AttachedLayer& layer : table.attached()) {
        const RoleInfo* const role = findRole(layer.partName);
        if (!role || role->name == "beauty") continue;
        const std::vector<FittingLayer> candidates = candidatesFor(*role, layer.part, table);
        if (const FittingLayer* const candidate = clearChoice(candidates, role->name))
            map.layers.insert_or_assign(std::string(role->name), candidate->expression);
    }
}

void requireAttached(const image::ExrDocument& file, const std::vector<ChannelTable>& tables,
                     const std::vector<LayerMap>& maps) {
    const auto parts = file.parts();
    for (size_t part = 0; part < parts.size(); ++part) {
        if (!parts[part].attached) continue;
        if (std::any_of(maps.begin(), maps.end(), [&](const LayerMap& map) { return map.uses(part); }))
            continue;
        const std::string& name = parts[part].name;
        if (name == "beauty")
            throw UsageError("--file beauty: the beauty is the input itself, since it is what is replaced");
        std::string why = "another file has this name, too";
        for (const ChannelTable& table : tables)
            for (const AttachedLayer& layer : table.attached())
                if (layer.part == part) why = whyUnused(layer, table);
        throw UsageError(fmt::format("--file {}: it is not used: {}", name, why));
    }
}

}  // namespace limpid::shot
