#include "renderer/layers/frame_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "base/error.h"
#include "image/metrics/geometry.h"
#include "renderer/frame/camera_text.h"
#include "shaders/common/scene_layout.h"

namespace limpid {
namespace {

using image::Image;
using image::LayeredImage;

/// Distances from here on mean that nothing was hit (files have 1e10).
constexpr float farAway = 9e9f;

bool has(const LayeredImage& file, const std::string& layer, std::string_view suffixes) {
    return std::all_of(suffixes.begin(), suffixes.end(),
                       [&](char suffix) { return file.find(layer + "." + suffix) != nullptr; });
}

void requireLayers(const LayeredImage& file, const std::filesystem::path& name, bool sequence) {
    std::string missing;
    const auto require = [&](const char* layer, std::string_view suffixes) {
        if (!has(file, layer, suffixes)) missing += std::string(missing.empty() ? "" : ", ") + layer;
    };
    for (const char* layer : {"diffuse", "specular", "emission", "albedo"}) require(layer, "RGB");
    require("normal", "XYZ");
    require("depth", "Z");
    if (sequence) require("motion", "XYZ");
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

/// As the file says; as many as networks learnt from if it does not.
uint32_t samplesOf(const LayeredImage& file) {
    constexpr uint32_t unknown = 32;
    const auto said = file.metadata.find("limpid.samples");
    if (said == file.metadata.end()) return unknown;
    uint32_t samples = 0;
    const std::string& text = said->second;
    std::from_chars(text.data(), text.data() + text.size(), samples);
    return samples > 0 ? samples : unknown;
}

constexpr const char* layersWithVariance[] = {"diffuse", "specular", "albedo", "normal", "depth"};

/// As the fourth of four; stays 0 without such a layer.
void addVariance(const LayeredImage& file, const std::string& layer, std::vector<float>& pixels) {
    const image::Channel* const variance = file.find(layer + ".variance");
    const auto ofDeviations = static_cast<float>(samplesOf(file) - 1);
    for (size_t p = 0; variance && p < variance->values.size(); ++p)
        pixels[4 * p + 3] = variance->values[p] * ofDeviations;
}

/// Four floats a pixel from three, and the mean squared deviation.
std::vector<float> fourOf(const LayeredImage& file, const char* layer, const char* suffixes = "RGB") {
    const Image image = file.get(layer, suffixes);
    const size_t pixels = size_t{image.width} * image.height;
    std::vector<float> result(4 * pixels);
    for (size_t p = 0; p < pixels; ++p) {
        for (size_t c = 0; c < 3; ++c) result[4 * p + c] = image.pixels[3 * p + c];
    }
    addVariance(file, layer, result);
    return result;
}

std::vector<float> depthOf(const Image& distances) {
    std::vector<float> result(4 * distances.pixels.size());
    for (size_t p = 0; p < distances.pixels.size(); ++p) {
        const float z = distances.pixels[p];
        if (!(z > 0.0f && z < farAway)) continue;
        result[4 * p] = z;
        result[4 * p + 1] = 1.0f;
    }
    return result;
}

/// All invalid if there is no such layer.
std::vector<float> motionOf(const LayeredImage& file, const char* layer, size_t pixels) {
    std::vector<float> result(4 * pixels);
    if (!has(file, layer, "XYZ")) return result;
    const Image motion = file.get(layer, "XYZ");
    for (size_t p = 0; p < pixels; ++p) {
        const float* m = &motion.pixels[3 * p];
        if (!image::validMotion(m[0], m[1]) || !std::isfinite(m[2])) continue;
        std::copy_n(m, 3, &result[4 * p]);
        result[4 * p + 3] = 1.0f;
    }
    return result;
}

std::vector<uint32_t> idsOf(const Image& numbers) {
    std::vector<uint32_t> result(2 * numbers.pixels.size(), layout::NONE);
    for (size_t p = 0; p < numbers.pixels.size(); ++p) {
        // In files 0 is nothing, and an instance has its number plus one.
        const float number = numbers.pixels[p];
        if (number >= 1.0f && number < 4e9f) result[2 * p] = static_cast<uint32_t>(number) - 1;
    }
    return result;
}

}  // namespace

void requireVariances(const LayeredImage& file, const std::filesystem::path& name) {
    std::string missing;
    for (const char* layer : layersWithVariance) {
        const std::string wanted = std::string(layer) + ".variance";
        if (!file.find(wanted)) missing += (missing.empty() ? "" : ", ") + wanted;
    }
    if (!missing.empty())
        throw InputError(name, "lacks the layers " + missing +
                                   ", which networks need ('limpid render --spp 32 --aov all' writes them)");
}

denoise::HostFrame frameOf(const LayeredImage& file, const std::filesystem::path& name, bool sequence,
                           std::vector<std::string>& lacking) {
    requireLayers(file, name, sequence);
    denoise::HostFrame frame;
    frame.width = file.width;
    frame.height = file.height;
    frame.camera = cameraOf(file, name);
    frame.diffuse = fourOf(file, "diffuse");
    frame.specular = fourOf(file, "specular");
    frame.emission = fourOf(file, "emission");
    frame.albedo = fourOf(file, "albedo");
    if (has(file, "albedoSpecular", "RGB")) frame.albedoSpecular = fourOf(file, "albedoSpecular");
    frame.normal = fourOf(file, "normal", "XYZ");
    frame.depth = depthOf(file.get("depth", "Z"));
    addVariance(file, "depth", frame.depth);
    frame.samples = samplesOf(file);
    frame.motion = motionOf(file, "motion", frame.pixelCount());
    frame.reflectionMotion = motionOf(file, "reflectionMotion", frame.pixelCount());
    if (has(file, "prevNormal", "XYZ")) {
        frame.previousNormal = fourOf(file, "prevNormal", "XYZ");
    } else {
        frame.previousNormal = frame.normal;
        if (sequence) lacking.push_back("prevNormal");
    }
    if (has(file, "id", "I")) {
        frame.ids = idsOf(file.get("id", "I"));
    } else {
        frame.ids.assign(2 * frame.pixelCount(), 0);
        if (sequence) lacking.push_back("id");
    }
    return frame;
}

}  // namespace limpid
