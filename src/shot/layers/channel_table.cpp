#include "shot/layers/channel_table.h"

#include <algorithm>

namespace limpid::shot {

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

ChannelTable::ChannelTable(std::span<const image::ExrPart> parts) {
    std::map<std::string_view, int> uses;
    for (const image::ExrPart& part : parts)
        for (const auto& channel : part.channels) uses[channel.name] += part.attached ? 0 : 1;
    std::map<std::string, LayerChannels> byName;
    std::vector<size_t> order;
    for (const bool attached : {true, false})
        for (size_t p = 0; p < parts.size(); ++p)
            if (parts[p].attached == attached) order.push_back(p);
    for (const size_t p : order) {
        if (!parts[p].unreadable.empty()) continue;
        for (const auto& channel : parts[p].channels) {
            const bool layerless = p > 0 && channel.name.find('.') == std::string::npos;
            const bool prefixed =
                parts[p].attached || (!parts[p].name.empty() && (uses[channel.name] > 1 || layerless));
            const std::string name = prefixed ? joined(parts[p].name, channel.name) : channel.name;
            if (!channels_.emplace(name, ChannelPlace{p, channel.name, channel.storage}).second) continue;
            const ChannelName pieces = split(name);
            LayerChannels& layer = byName[std::string(pieces.layer)];
            layer.name = pieces.layer;
            layer.components.emplace_back(pieces.component);
        }
    }
    for (auto& [name, layer] : byName) layers_.push_back(std::move(layer));
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
