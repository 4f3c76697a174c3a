#include "renderer/layers/frame_file.h"

#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <string_view>

#include "base/error.h"
#include "image/metrics/geometry.h"
#include "renderer/frame/camera_text.h"
#include "renderer/layers/layers.h"
#include "shaders/common/scene_layout.h"

namespace limpid {
namespace {

using image::LayeredImage;

/// From this distance on, nothing was hit (files have 1e10).
constexpr float farAway = 9e9f;

bool has(const LayeredImage& file, const LayerInfo& layer) {
    return std::all_of(layer.suffixes.begin(), layer.suffixes.end(), [&](char suffix) {
        return file.find(std::string(layer.name) + "." + suffix) != nullptr;
    });
}

/// "albedo.variance": the channel's name in files of Limpid 0.2.
std::string shortVarianceName(const LayerInfo& layer) {
    const std::string name = varianceChannel(layer);
    return name.substr(0, name.rfind('.'));
}

/// Returns the layer's variance channel, under either name; null if there is none.
const image::Channel* varianceOf(const LayeredImage& file, const LayerInfo& layer) {
    const image::Channel* const channel = file.find(varianceChannel(layer));
    return channel ? channel : file.find(shortVarianceName(layer));
}

void addName(std::string& list, std::string_view name) {
    if (!list.empty()) list += ", ";
    list += name;
}

void requireLayers(const LayeredImage& file, const std::filesystem::path& name, bool sequence) {
    std::string missing;
    for (const LayerInfo& layer : frameLayers) {
        const bool needed = layer.need == Need::Always || (sequence && layer.need == Need::InSequences);
        if (needed && !has(file, layer)) addName(missing, layer.name);
    }
    if (!missing.empty()) {
        throw InputError(name, "lacks the layers " + missing +
                                   ", which denoising needs ('limpid render --aov all' writes them)");
    }
}

CameraParams cameraOf(const LayeredImage& file, const std::filesystem::path& name) {
    const auto text = file.metadata.find(cameraAttribute);
    if (text == file.metadata.end())
        throw InputError(name, std::string("lacks the attribute '") + cameraAttribute +
                                   "', the camera, which denoising needs ('limpid render' writes it)");
    const std::optional<CameraParams> camera = parseCameraText(text->second);
    if (!camera)
        throw InputError(name, std::string("'") + cameraAttribute + "' is not a camera: " + text->second);
    return *camera;
}

/// Returns nothing if the file has none.
std::optional<vec2> jitterOf(const LayeredImage& file, const std::filesystem::path& name) {
    const auto text = file.metadata.find(jitterAttribute);
    if (text == file.metadata.end()) return std::nullopt;
    const std::optional<vec2> jitter = parseJitterText(text->second);
    if (!jitter)
        throw InputError(name,
                         std::string("'") + jitterAttribute + "' is no point of a pixel: " + text->second);
    return jitter;
}

/// Returns the file's number of samples, or the number that networks were trained on if the file has none.
uint32_t samplesOf(const LayeredImage& file) {
    constexpr uint32_t unknown = 32;
    const auto said = file.metadata.find("limpid.samples");
    if (said == file.metadata.end()) return unknown;
    uint32_t samples = 0;
    const std::string& text = said->second;
    std::from_chars(text.data(), text.data() + text.size(), samples);
    return samples > 0 ? samples : unknown;
}

bool knowsVarianceOfLight(const LayeredImage& file) {
    return std::all_of(frameLayers.begin(), frameLayers.end(), [&](const LayerInfo& layer) {
        return !layer.inBeauty || !layer.varianceInFiles || varianceOf(file, layer);
    });
}

/// Reads the values that the file's channels have.
ChannelReader readerOf(const LayeredImage& file) {
    return [&file](const std::string& channel, std::span<float> to, size_t stride) {
        const std::vector<float>& values = file.find(channel)->values;
        for (size_t p = 0; p < values.size(); ++p) to[stride * p] = values[p];
    };
}

/// Writes the variance as the fourth of four components; it stays 0 if the file has none.
void addVariance(const LayeredImage& file, const ChannelReader& reader, const LayerInfo& layer,
                 std::vector<float>& texels) {
    const image::Channel* const variance = varianceOf(file, layer);
    if (!variance) return;
    reader(variance->name, std::span(texels).subspan(3), 4);
    const auto ofDeviations = static_cast<float>(samplesOf(file) - 1);
    for (size_t at = 3; at < texels.size(); at += 4) texels[at] *= ofDeviations;
}

/// True if a layer with a share of samples has a value here.
bool isValue(const LayerInfo& layer, const float* components) {
    if (layer.suffixes.size() == 1) return components[0] > 0.0f && components[0] < farAway;
    return image::validMotion(components[0], components[1]) && std::isfinite(components[2]);
}

/// Reads a mean, four floats per pixel.
void read(const LayeredImage& file, const ChannelReader& reader, const LayerInfo& layer,
          std::vector<float>& texels) {
    const size_t count = layer.suffixes.size();
    for (size_t c = 0; c < count; ++c)
        reader(std::string(layer.name) + "." + layer.suffixes[c], std::span(texels).subspan(c), 4);
    for (size_t at = 0; layer.hasShare() && at < texels.size(); at += 4) {
        const bool isThere = isValue(layer, &texels[at]);
        if (!isThere) std::fill_n(&texels[at], count, 0.0f);
        texels[at + count] = isThere ? 1.0f : 0.0f;
    }
    if (layer.varianceOf != VarianceOf::Nothing) addVariance(file, reader, layer, texels);
}

/// Reads instance numbers, two integers per pixel. In files 0 is a miss, and an instance is its number plus
/// one.
void read(const LayeredImage& file, const ChannelReader& reader, const LayerInfo& layer,
          std::vector<uint32_t>& ids) {
    std::vector<float> numbers(size_t{file.width} * file.height);
    reader(std::string(layer.name) + "." + layer.suffixes[0], numbers, 1);
    std::fill(ids.begin(), ids.end(), layout::NONE);
    for (size_t p = 0; p < numbers.size(); ++p) {
        const float number = numbers[p];
        if (number >= 1.0f && number < 4e9f) ids[2 * p] = static_cast<uint32_t>(number) - 1;
    }
}

}  // namespace

std::vector<const LayerInfo*> lackingVariances(const LayeredImage& file) {
    std::vector<const LayerInfo*> lacking;
    for (const LayerInfo& layer : frameLayers)
        if (layer.varianceInFiles && !varianceOf(file, layer)) lacking.push_back(&layer);
    return lacking;
}

denoise::HostFrame frameOf(const LayeredImage& file, const std::filesystem::path& name, bool sequence,
                           std::vector<const LayerInfo*>& lacking, const ChannelReader& reader) {
    if (!reader) return frameOf(file, name, sequence, lacking, readerOf(file));
    requireLayers(file, name, sequence);
    denoise::HostFrame frame;
    frame.width = file.width;
    frame.height = file.height;
    frame.camera = cameraOf(file, name);
    frame.samples = samplesOf(file);
    frame.variances = frame.samples > 1 && knowsVarianceOfLight(file);
    frame.jitter = jitterOf(file, name);
    const auto makePixels = [&](const LayerInfo& layer, auto& texels) {
        texels.resize((layer.stored == Stored::Uint ? 2 : 4) * frame.pixelCount());
    };
    std::vector<std::function<void()>> readers;
    frame.forEach([&](const LayerInfo& layer, auto& texels) {
        if (has(file, layer)) {
            readers.push_back([&] {
                makePixels(layer, texels);
                read(file, reader, layer, texels);
            });
        } else if (sequence && layer.need == Need::Advised) {
            lacking.push_back(&layer);
        }
    });
    tbb::parallel_for_each(readers, [](const auto& run) { run(); });
    if (frame.previousNormal.empty()) frame.previousNormal = frame.normal;  // as if nothing rotated
    frame.forEach(
        [&](const LayerInfo& layer, auto& texels) {  // zeros for missing layers: no motion, one object
            if (layer.forFilters != ForFilters::Nothing) makePixels(layer, texels);
        });
    return frame;
}

}  // namespace limpid
