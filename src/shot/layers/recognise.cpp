#include "shot/layers/recognise.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "shot/layers/attached_roles.h"
#include "shot/layers/conventions.h"

namespace limpid::shot {
namespace {

/// `sign` is "name", or "name=beginning of the text".
bool hasAttribute(const image::ExrDocument& file, std::string_view sign) {
    const size_t equals = std::min(sign.find('='), sign.size());
    const std::string key(sign.substr(0, equals));
    const std::string_view beginning = sign.substr(std::min(equals + 1, sign.size()));
    return std::any_of(file.parts().begin(), file.parts().end(), [&](const image::ExrPart& part) {
        const auto text = part.texts.find(key);
        if (text != part.texts.end()) return text->second.starts_with(beginning);
        return beginning.empty() && (part.numbers.contains(key) || part.matrices.contains(key));
    });
}

/// What precedes `layer` in the names of layers that end with it: "" or "ViewLayer.".
std::vector<std::string> prefixesOf(const ChannelTable& table, std::string_view layer) {
    std::vector<std::string> result;
    for (const LayerChannels& candidate : table.layers()) {
        const std::string_view name = candidate.name;
        if (!name.ends_with(layer)) continue;
        const std::string_view before = name.substr(0, name.size() - layer.size());
        if (layer.empty() && !before.empty()) continue;  // the unnamed layer ends every name
        if (before.empty() || before.ends_with('.')) result.emplace_back(before);
    }
    return result;
}

bool fits(const Convention& convention, const image::ExrDocument& file, const ChannelTable& table,
          std::string_view prefix) {
    if (convention.evidence.empty()) return true;
    return std::any_of(convention.evidence.begin(), convention.evidence.end(), [&](std::string_view sign) {
        return sign.starts_with('@') ? hasAttribute(file, sign.substr(1))
                                     : table.layer(std::string(prefix) + std::string(sign)) != nullptr;
    });
}

/// Alpha is the fourth component of the beauty's layer. All renderers multiply colours by it.
void addAlpha(const ChannelTable& table, std::string_view layer, LayerMap& map) {
    const ChannelPlace beauty = map.layers.at("beauty").places().front();
    for (const char* name : {"A", "a", "alpha", "Alpha"}) {
        if (map.find("alpha")) return;
        auto alpha = LayerExpression::resolve(joined(layer, name), table, map.prefix);
        // Of the parts' channels "R" and "A", only those that several parts have are named after their part.
        if (!alpha && split(beauty.channel).layer.empty()) alpha = LayerExpression::resolve(name, table);
        if (alpha && alpha->places().front().part == beauty.part)
            map.layers.emplace("alpha", std::move(*alpha));
    }
}

/// Blender keeps the noisy picture beside the one that it has denoised, which cannot be cleaned well: its
/// noise is in blotches, and it is not the sum of the layers of light.
void preferNoisy(const Convention& convention, const ChannelTable& table, LayerMap& map) {
    if (convention.noisy.empty()) return;
    auto noisy = LayerExpression::resolve(convention.noisy, table, map.prefix);
    if (!noisy) return;
    map.replaced = map.layers.at("beauty");
    map.remarks.push_back(
        fmt::format("'{}' is denoised already; '{}' is cleaned instead, and takes its place",
                    split(map.replaced->text()).layer, split(noisy->text()).layer));
    map.layers.insert_or_assign("beauty", std::move(*noisy));
}

/// `layer`: the beauty's, without the prefix.
LayerMap mapOf(const Convention& convention, const ChannelTable& table, const std::string& prefix,
               std::string_view layer, LayerExpression beauty) {
    LayerMap map;
    map.prefix = prefix;
    map.title = prefix.empty() ? "" : prefix.substr(0, prefix.size() - 1);
    map.renderer = convention.renderer;
    map.encoding = convention.encoding;
    map.hasIndependentPixels = convention.hasIndependentPixels;
    map.layers.emplace("beauty", std::move(beauty));
    addAttachedRoles(table, map);
    addAlpha(table, layer, map);
    preferNoisy(convention, table, map);
    for (const Rule& rule : convention.rules) {
        if (map.find(rule.role)) continue;
        auto expression = LayerExpression::resolve(rule.expression, table, prefix, rule.partial);
        if (!expression || expression->components() != findRole(rule.role)->components) continue;
        map.layers.emplace(rule.role, std::move(*expression));
        for (const EncodingRule& change : convention.encodingRules)
            if (change.role == rule.role && change.expression == rule.expression) change.set(map.encoding);
    }
    const std::string group = prefix + std::string(convention.group);
    for (const LayerChannels& each : table.layers()) {
        if (convention.group.empty() || !each.name.starts_with(group)) continue;
        auto expression = LayerExpression::resolve(each.name + ".RGB", table);
        if (expression && expression->components() == 3) map.groups.push_back(std::move(*expression));
    }
    return map;
}

/// A picture that was made of the others has no guides. It was made of noise, and making it again of the
/// clean ones is better than cleaning it.
void dropComposite(const Convention& convention, std::vector<LayerMap>& maps) {
    const auto composite = std::find_if(maps.begin(), maps.end(), [&](const LayerMap& map) {
        return !convention.composite.empty() && map.prefix == convention.composite;
    });
    if (composite == maps.end()) return;
    const bool hasBetter = std::any_of(maps.begin(), maps.end(), [&](const LayerMap& map) {
        return map.replaced || map.layers.size() > composite->layers.size();
    });
    if (!hasBetter) return;
    const std::string title = composite->title;
    maps.erase(composite);
    maps.front().remarks.push_back(
        fmt::format("'{}' stays as it was: the compositor made it of the noisy layers", title));
}

bool isAttached(const image::ExrDocument& file, const LayerExpression& expression) {
    const std::vector<ChannelPlace> places = expression.places();
    return std::any_of(places.begin(), places.end(),
                       [&](const ChannelPlace& place) { return file.parts()[place.part].attached; });
}

std::vector<LayerMap> mapsBy(const Convention& convention, const image::ExrDocument& file,
                             const ChannelTable& table) {
    std::vector<LayerMap> maps;
    for (const std::string_view beauty : convention.beauties) {
        const std::string_view layer = split(beauty).layer;
        for (const std::string& prefix : prefixesOf(table, layer)) {
            if (!fits(convention, file, table, prefix)) continue;
            auto expression = LayerExpression::resolve(beauty, table, prefix);
            if (expression && expression->components() == 3 && !isAttached(file, *expression))
                maps.push_back(mapOf(convention, table, prefix, layer, std::move(*expression)));
        }
        if (!maps.empty()) break;
    }
    dropComposite(convention, maps);
    return maps;
}

/// The pictures of one view, by the first convention that finds any.
std::vector<LayerMap> mapsOfView(const image::ExrDocument& file, const ChannelTable& table,
                                 const std::string& view) {
    std::vector<LayerMap> maps;
    for (const Convention& convention : conventions()) {
        maps = mapsBy(convention, file, table);
        if (!maps.empty()) break;
    }
    for (LayerMap& map : maps) map.view = view;
    return maps;
}

/// Whether assignments name a layer of this view as its beauty.
bool namesBeauty(const Assignments& assignments, const ChannelTable& table) {
    return std::any_of(assignments.begin(), assignments.end(), [&](const auto& a) {
        return a.first == "beauty" && LayerExpression::resolve(a.second, table);
    });
}

/// What a file without colours is: an error, unless assignments name its beauty.
void requireBeauty(const image::ExrDocument& file, const Assignments& assignments) {
    if (std::any_of(assignments.begin(), assignments.end(),
                    [](const auto& a) { return a.first == "beauty"; }))
        return;
    for (const image::ExrPart& part : file.parts())
        if (!part.unreadable.empty())
            throw InputError(file.name(), part.unreadable + ", which is not supported");
    throw InputError(file.name(), "has no layer of colours; --map beauty=LAYER.RGB names one");
}

}  // namespace

std::vector<LayerMap> recognise(const image::ExrDocument& file, const Assignments& assignments) {
    std::vector<std::string> views = viewsOf(file.parts());
    if (views.empty()) views.emplace_back();
    std::vector<LayerMap> result;
    std::vector<ChannelTable> tables;
    for (const std::string& view : views) {
        const ChannelTable& table = tables.emplace_back(file.parts(), view);
        std::vector<LayerMap> maps = mapsOfView(file, table, view);
        const bool nothing = maps.empty() && result.empty() && &view == &views.back();
        if (nothing) requireBeauty(file, assignments);
        if (nothing || (maps.empty() && namesBeauty(assignments, table))) {
            maps.emplace_back().view = view;
            addAttachedRoles(table, maps.back());
        }
        for (LayerMap& map : maps) {
            apply(assignments, table, file.name(), map);
            if (!map.find("beauty")) throw UsageError("--map: the beauty is needed");
            result.push_back(std::move(map));
        }
    }
    requireAttached(file, tables, result);
    return result;
}

}  // namespace limpid::shot
