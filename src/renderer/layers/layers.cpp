#include "renderer/layers/layers.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "image/metrics/geometry.h"

namespace limpid {
namespace {

using image::Image;
using image::Storage;

/// `count` components of four, starting with `first`.
Image components(const std::vector<float>& texels, gpu::Extent extent, uint32_t first, uint32_t count) {
    Image out(extent.width, extent.height, count);
    const size_t pixels = size_t{extent.width} * extent.height;
    for (size_t p = 0; p < pixels; ++p) {
        for (uint32_t c = 0; c < count; ++c) out.pixels[p * count + c] = texels[p * 4 + first + c];
    }
    return out;
}

/// s^2 / N: the variance of the mean. One sample says nothing of it: 0.
Image varianceOfMean(const std::vector<float>& texels, gpu::Extent extent, uint64_t samples) {
    Image out = components(texels, extent, 3, 1);
    const float divisor = samples > 1 ? static_cast<float>(samples - 1) : 1.0f;
    for (float& v : out.pixels) v = samples > 1 ? v / divisor : 0.0f;
    return out;
}

/// Divides by the share of samples that were valid (component `share` of four).
Image perValidSample(const std::vector<float>& texels, gpu::Extent extent, uint32_t share, uint32_t count,
                     float otherwise) {
    Image out = components(texels, extent, 0, count);
    const size_t pixels = size_t{extent.width} * extent.height;
    for (size_t p = 0; p < pixels; ++p) {
        const float valid = texels[p * 4 + share];
        for (uint32_t c = 0; c < count; ++c) {
            float& value = out.pixels[p * count + c];
            value = valid > 0.0f ? value / valid : otherwise;
        }
    }
    return out;
}

Image idImage(const RenderedLayers& layers) {
    Image out(layers.extent.width, layers.extent.height, 1);
    // 0: nothing; otherwise the instance's number plus one.
    for (size_t p = 0; p < out.pixels.size(); ++p) out.pixels[p] = static_cast<float>(layers.ids[2 * p] + 1u);
    return out;
}

}  // namespace

const std::vector<std::string>& layerNames() {
    static const std::vector<std::string> names{
        "beauty",     "diffuse", "specular", "emission",         "albedo", "albedoSpecular", "normal",
        "prevNormal", "depth",   "motion",   "reflectionMotion", "id",     "variance",       "samples"};
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
    const auto wants = [&](std::string_view name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    const auto addColor = [&](const char* name, const std::vector<float>& texels) {
        if (wants(name)) out.add(name, "RGB", components(texels, extent, 0, 3), colorStorage);
    };
    addColor("diffuse", layers.diffuse);
    addColor("specular", layers.specular);
    addColor("emission", layers.emission);
    addColor("albedo", layers.albedo);
    addColor("albedoSpecular", layers.albedoSpecular);
    if (wants("normal")) out.add("normal", "XYZ", components(layers.normal, extent, 0, 3), colorStorage);
    if (wants("prevNormal")) {
        out.add("prevNormal", "XYZ", components(layers.previousNormal, extent, 0, 3), colorStorage);
    }
    if (wants("depth"))
        out.add("depth", "Z", perValidSample(layers.depth, extent, 1, 1, missDepth), Storage::Float);
    const auto addMotion = [&](const char* name, const std::vector<float>& texels) {
        if (!wants(name) || texels.empty()) return;
        out.add(name, "XYZ", perValidSample(texels, extent, 3, 3, image::invalidMotion), Storage::Float);
    };
    addMotion("motion", layers.motion);
    addMotion("reflectionMotion", layers.reflectionMotion);
    if (wants("id")) out.add("id", "I", idImage(layers), Storage::Uint);
    if (wants("samples")) {
        const Image count(extent.width, extent.height, 1, static_cast<float>(layers.samples));
        out.add("samples", "N", count, Storage::Float);
    }
    if (!wants("variance")) return out;
    const auto addVariance = [&](const char* name, const std::vector<float>& texels) {
        const Image variance = varianceOfMean(texels, extent, layers.samples);
        out.channels.push_back({std::string(name) + ".variance", Storage::Float, variance.pixels});
    };
    addVariance("diffuse", layers.diffuse);
    addVariance("specular", layers.specular);
    addVariance("albedo", layers.albedo);
    addVariance("normal", layers.normal);
    addVariance("depth", layers.depth);
    return out;
}

}  // namespace limpid
