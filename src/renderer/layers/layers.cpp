#include "renderer/layers/layers.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace limpid {
namespace {

using image::Image;
using image::Storage;

/// Returns `count` of the four components, from `first` on.
Image components(const std::vector<float>& texels, gpu::Extent extent, uint32_t first, uint32_t count) {
    Image out(extent.width, extent.height, count);
    const size_t pixels = size_t{extent.width} * extent.height;
    for (size_t p = 0; p < pixels; ++p) {
        for (uint32_t c = 0; c < count; ++c) out.pixels[p * count + c] = texels[p * 4 + first + c];
    }
    return out;
}

/// Returns s^2 / N, the variance of the mean; 0 for a single sample, which has no variance.
Image varianceOfMean(const std::vector<float>& texels, gpu::Extent extent, uint64_t samples) {
    Image out = components(texels, extent, 3, 1);
    const float divisor = samples > 1 ? static_cast<float>(samples - 1) : 1.0f;
    for (float& v : out.pixels) v = samples > 1 ? v / divisor : 0.0f;
    return out;
}

/// Returns the components of a mean, divided by the share of samples that have a value, if there is one.
Image imageOf(const LayerInfo& layer, const std::vector<float>& texels, gpu::Extent extent) {
    const auto count = static_cast<uint32_t>(layer.suffixes.size());
    Image out = components(texels, extent, 0, count);
    const size_t pixels = size_t{extent.width} * extent.height;
    for (size_t p = 0; layer.hasShare() && p < pixels; ++p) {
        const float valid = texels[p * 4 + count];
        for (uint32_t c = 0; c < count; ++c) {
            float& value = out.pixels[p * count + c];
            value = valid > 0.0f ? value / valid : noValue;
        }
    }
    return out;
}

/// 0: a miss; otherwise the instance's number plus one.
Image imageOf(const LayerInfo&, const std::vector<uint32_t>& ids, gpu::Extent extent) {
    Image out(extent.width, extent.height, 1);
    for (size_t p = 0; p < out.pixels.size(); ++p) out.pixels[p] = static_cast<float>(ids[2 * p] + 1u);
    return out;
}

Storage storageOf(const LayerInfo& layer, Storage colorStorage) {
    switch (layer.stored) {
        case Stored::Color:
            break;
        case Stored::Float:
            return Storage::Float;
        case Stored::Uint:
            return Storage::Uint;
    }
    return colorStorage;
}

}  // namespace

const std::vector<std::string>& layerNames() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> list;
        for (const LayerInfo& layer : layerTable) list.emplace_back(layer.name);
        return list;
    }();
    return names;
}

std::vector<std::string> parseLayers(std::string_view list) {
    if (list == "all") return layerNames();
    std::vector<std::string> result;
    while (!list.empty()) {
        const size_t comma = std::min(list.find(','), list.size());
        const std::string name(list.substr(0, comma));
        if (std::find(layerNames().begin(), layerNames().end(), name) == layerNames().end()) {
            std::string all;
            for (const std::string& known : layerNames()) all += " " + known;
            throw UsageError("there is no layer '" + name + "'; the layers are: all" + all);
        }
        result.push_back(name);
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
    return result;
}

Image beautyOf(const RenderedLayers& layers) {
    if (!layers.beauty.empty()) return components(layers.beauty, layers.extent, 0, 3);
    Image sum = components(layers.diffuse, layers.extent, 0, 3);
    const Image emission = components(layers.emission, layers.extent, 0, 3);
    if (layers.specular.empty()) {
        for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += emission.pixels[i];
        return sum;
    }
    const Image specular = components(layers.specular, layers.extent, 0, 3);
    for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += specular.pixels[i] + emission.pixels[i];
    return sum;
}

std::vector<float> surfaceShare(const RenderedLayers& layers) {
    if (!layers.depth.empty()) return components(layers.depth, layers.extent, 1, 1).pixels;
    if (!layers.beauty.empty()) return components(layers.beauty, layers.extent, 3, 1).pixels;
    return {};
}

image::LayeredImage toLayeredImage(const RenderedLayers& layers, const std::vector<std::string>& names,
                                   Storage colorStorage) {
    const gpu::Extent extent = layers.extent;
    image::LayeredImage out;
    out.width = extent.width;
    out.height = extent.height;
    out.add("", "RGB", beautyOf(layers), colorStorage);
    out.add("", "A", Image(extent.width, extent.height, 1, 1.0f), colorStorage);
    const auto wants = [&](const LayerInfo& layer) {
        return std::find(names.begin(), names.end(), layer.name) != names.end();
    };
    layers.forEach([&](const LayerInfo& layer, const auto& texels) {
        if (!wants(layer) || texels.empty()) return;
        out.add(layer.name, layer.suffixes, imageOf(layer, texels, extent), storageOf(layer, colorStorage));
    });
    if (wants(samplesLayer)) {
        const Image count(extent.width, extent.height, 1, static_cast<float>(layers.samples));
        out.add(samplesLayer.name, samplesLayer.suffixes, count, storageOf(samplesLayer, colorStorage));
    }
    for (const LayerInfo& layer : frameLayers) {
        if (!wants(varianceLayer) || !layer.varianceInFiles || layers[layer].empty()) continue;
        const Image variance = varianceOfMean(layers[layer], extent, layers.samples);
        out.channels.push_back(
            {varianceChannel(layer), storageOf(varianceLayer, colorStorage), variance.pixels});
    }
    return out;
}

std::string varianceChannel(const LayerInfo& layer) {
    return std::string(layer.name) + "." + std::string(varianceLayer.name) + ".V";
}

}  // namespace limpid
