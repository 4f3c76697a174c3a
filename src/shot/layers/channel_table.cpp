#include "shot/layers/channel_table.h"

#include <algorithm>

namespace limpid::shot {
namespace {

/// A channel, and its name without its view.
struct Named {
    size_t part;
    const image::ExrPart::Channel* source;
    std::string name;
};

bool isOf(const std::vector<std::string>& views, std::string_view name) {
    return std::find(views.begin(), views.end(), name) != views.end();
}

/// "diffuse.left.R": "left", and without it "diffuse.R". The view is empty if the name has none.
std::pair<std::string_view, std::string> viewInName(std::string_view channel,
                                                    const std::vector<std::string>& views) {
    const ChannelName name = split(channel);
    const std::string_view last = split(name.layer).component;
    if (!isOf(views, last)) return {{}, std::string(channel)};
    return {last, joined(split(name.layer).layer, name.component)};
}

/// "albedo.right" and "albedo_right": "right".
std::string_view viewOfPart(const image::ExrPart& part, const std::vector<std::string>& views) {
    const size_t end = part.name.find_last_of("._");
    const std::string_view last = std::string_view(part.name).substr(end + 1);  // all without a separator
    return isOf(views, last) ? last : std::string_view(views.front());
}

/// The part's name without its view.
std::string partName(const image::ExrPart& part, const std::string& view) {
    const bool ends =
        !view.empty() && part.name.size() > view.size() && part.name.ends_with(view) &&
        std::string_view("._").find(part.name[part.name.size() - view.size() - 1]) != std::string_view::npos;
    return ends ? part.name.substr(0, part.name.size() - view.size() - 1) : part.name;
}

/// The channels of a view, attached parts first.
std::vector<Named> channelsIn(std::span<const image::ExrPart> parts, const std::string& view) {
    const std::vector<std::string> views = view.empty() ? std::vector<std::string>{} : viewsOf(parts);
    std::vector<Named> result;
    const auto add = [&](size_t p) {
        for (const auto& channel : parts[p].channels) {
            auto [own, name] = viewInName(channel.name, views);
            if (!parts[p].view.empty()) own = parts[p].view;
            if (own.empty() && !views.empty()) own = viewOfPart(parts[p], views);
            if (view.empty() || own == view) result.push_back({p, &channel, std::move(name)});
        }
    };
    for (const bool attached : {true, false})
        for (size_t p = 0; p < parts.size(); ++p)
            if (parts[p].attached == attached) add(p);
    return result;
}

}  // namespace

ChannelName split(std::string_view channel) {
    const size_t dot = channel.rfind('.');
    if (dot == std::string_view::npos) return {{}, channel};
    return {channel.substr(0, dot), channel.substr(dot + 1)};
}

std::string joined(std::string_view layer, std::string_view component) {
    std::string result(layer);
    if (!result.empty()) result += '.';
    return result += component;
}

std::vector<std::string> viewsOf(std::span<const image::ExrPart> parts) {
    std::vector<std::string> views;
    const auto add = [&](const std::string& view) {
        if (!view.empty() && std::find(views.begin(), views.end(), view) == views.end())
            views.push_back(view);
    };
    for (const image::ExrPart& part : parts) std::for_each(part.views.begin(), part.views.end(), add);
    for (const image::ExrPart& part : parts) add(part.view);
    return views;
}

ChannelTable::ChannelTable(std::span<const image::ExrPart> parts, const std::string& view) {
    const std::vector<Named> all = channelsIn(parts, view);
    std::map<std::string_view, int> uses;
    for (const Named& channel : all) uses[channel.name] += parts[channel.part].attached ? 0 : 1;
    size_t first = parts.size();
    for (const Named& channel : all)
        if (!parts[channel.part].attached) first = std::min(first, channel.part);
    std::map<std::string, LayerChannels> byName;
    for (const Named& channel : all) {
        const image::ExrPart& part = parts[channel.part];
        if (!part.unreadable.empty()) continue;
        const bool layerless = channel.part != first && channel.name.find('.') == std::string::npos;
        const bool prefixed = part.attached || (!part.name.empty() && (uses[channel.name] > 1 || layerless));
        const std::string name = prefixed ? joined(partName(part, view), channel.name) : channel.name;
        const ChannelPlace place{channel.part, channel.source->name, channel.source->storage};
        if (!channels_.emplace(name, place).second) continue;
        const ChannelName pieces = split(name);
        if (part.attached) addAttached(channel.part, partName(part, view), pieces);
        LayerChannels& layer = byName[std::string(pieces.layer)];
        layer.name = pieces.layer;
        layer.components.emplace_back(pieces.component);
    }
    for (auto& [name, layer] : byName) layers_.push_back(std::move(layer));
}

void ChannelTable::addAttached(size_t part, std::string partName, const ChannelName& channel) {
    auto found = std::find_if(attached_.begin(), attached_.end(), [&](const AttachedLayer& layer) {
        return layer.part == part && layer.channels.name == channel.layer;
    });
    if (found == attached_.end())
        found = attached_.insert(found, {part, std::move(partName), {std::string(channel.layer), {}}});
    found->channels.components.emplace_back(channel.component);
}

const ChannelPlace* ChannelTable::find(std::string_view name) const {
    const auto found = channels_.find(name);
    return found == channels_.end() ? nullptr : &found->second;
}

const LayerChannels* ChannelTable::layer(std::string_view name) const {
    const auto found = std::find_if(layers_.begin(), layers_.end(),
                                    [&](const LayerChannels& layer) { return layer.name == name; });
    return found == layers_.end() ? nullptr : &*found;
}

}  // namespace limpid::shot
