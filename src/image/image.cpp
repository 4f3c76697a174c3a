#include "image/image.h"

#include <fmt/format.h>

#include "base/error.h"

namespace limpid::image {
namespace {

std::string channelName(std::string_view layer, char suffix) {
    return layer.empty() ? std::string(1, suffix) : fmt::format("{}.{}", layer, suffix);
}

}  // namespace

const Channel* LayeredImage::find(std::string_view name) const {
    for (const Channel& channel : channels) {
        if (channel.name == name) return &channel;
    }
    return nullptr;
}

void LayeredImage::add(std::string_view layer, std::string_view suffixes, const Image& image,
                       Storage storage) {
    if (channels.empty() && width == 0 && height == 0) {
        width = image.width;
        height = image.height;
    }
    if (image.width != width || image.height != height || suffixes.size() > image.components) {
        throw Error(fmt::format("layer '{}' is {}x{} with {} components; the image is {}x{} and needs {}",
                                layer, image.width, image.height, image.components, width, height,
                                suffixes.size()));
    }
    const size_t count = size_t{width} * height;
    for (size_t c = 0; c < suffixes.size(); ++c) {
        Channel channel{channelName(layer, suffixes[c]), storage, std::vector<float>(count)};
        if (find(channel.name)) throw Error(fmt::format("channel '{}' is there already", channel.name));
        for (size_t i = 0; i < count; ++i) channel.values[i] = image.pixels[i * image.components + c];
        channels.push_back(std::move(channel));
    }
}

Image LayeredImage::get(std::string_view layer, std::string_view suffixes) const {
    const auto components = static_cast<uint32_t>(suffixes.size());
    Image image(width, height, components);
    for (uint32_t c = 0; c < components; ++c) {
        const std::string name = channelName(layer, suffixes[c]);
        const Channel* channel = find(name);
        if (!channel) throw Error(fmt::format("there is no channel '{}'", name));
        for (size_t i = 0; i < channel->values.size(); ++i)
            image.pixels[i * components + c] = channel->values[i];
    }
    return image;
}

std::optional<std::string> LayeredImage::colorLayer() const {
    std::optional<std::string> best;
    for (const Channel& channel : channels) {
        if (!channel.name.ends_with(".R")) continue;
        const std::string layer = channel.name.substr(0, channel.name.size() - 2);
        if (!find(layer + ".G") || !find(layer + ".B")) continue;
        const bool combined = layer.ends_with("Combined");
        if (!best || (combined && !best->ends_with("Combined"))) best = layer;
    }
    if (find("R") && find("G") && find("B")) best = "";
    return best;
}

}  // namespace limpid::image
